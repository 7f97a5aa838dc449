// Error against time of several methods on one scene: settings, and the interface that receives reports.
//
// Everything is read and checked before the first pass; then methods take turns; then the results are
// plotted.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/render/render_driver.h"
#include "session/loaded_scene.h"

namespace mote::trade {

struct Settings {
    std::string scene;
    session::SceneChanges changes;  ///< of the scene, for all methods
    std::string reference;          ///< EXR; "": one is rendered into the folder
    std::string methods;            ///< JSON; "": those that suit the scene
    std::string output;             ///< folder; "": SCENE_trade
    std::optional<double> seconds;  ///< wall time per method and seed; replaces what the methods file says
    std::optional<std::uint32_t> passes, seeds;
    double resolve = 0.01, checkpoint_every = 60.0;  ///< relative error that must be judged; [s]
    int threads = 0, page_width = 640;               ///< page_width: of the images in the page [pixels]
    bool fresh = false, trust_reference = false, force_reference = false;
    std::vector<std::string> command_line;
};

/// Settings of a reference, besides the scene and the limits of Settings.
struct ReferenceSettings {
    std::string path;        ///< EXR; a PNG preview and a checkpoint lie beside it
    bool named = true;       ///< by the user
    std::string integrator;  ///< "": volpath in media, else path
    std::vector<std::pair<std::string, std::string>> settings;  ///< of the integrator
};

/// Receives what a trade reports, and says when it is to stop.
class Host {
  public:
    virtual ~Host() = default;
    virtual void note(const std::string& text) = 0;    ///< always
    virtual void remark(const std::string& text) = 0;  ///< may be left out
    /// From now on progress is reported, under this header, until end().
    virtual void begin(const std::string& header) = 0;
    virtual void progress(const core::RenderProgress& progress) = 0;
    virtual void progress(const std::string& text, double seconds_left, bool urgent) = 0;
    virtual void end() = 0;
    /// During `phase` an end loses nothing, for the reason `why`; both are literals. Null: it does.
    virtual void idle_while(const char* phase, const char* why = "no pixel was rendered yet") = 0;
    virtual const std::atomic<bool>& interrupted() const = 0;  ///< ends the work, which can be continued
};

/// Measures and draws. Returns false when it was interrupted. Throws InputError.
bool measure(const Settings& settings, Host& host);
/// Renders until the reference judges errors of `settings.resolve`, or the limits are reached. Returns false
/// when it was interrupted. Throws InputError.
bool make_reference(const Settings& settings, const ReferenceSettings& reference, Host& host);
/// Draws the records of `folder` again. Throws InputError where there are none.
void redraw(const std::string& folder, int page_width);
/// The folder that measure() writes into.
std::string folder_of(const Settings& settings);

}  // namespace mote::trade
