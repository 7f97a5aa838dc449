// Arguments of each subcommand, as the command line gave them, and the functions that run them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/film/tone.h"
#include "core/formats/xml/scene_loader.h"
#include "core/objects/registry.h"
#include "core/render/integrator.h"
#include "core/render/motion_features.h"
#include "core/scene/scene.h"
#include "session/loaded_scene.h"
#include "session/registry.h"

namespace mote::apps {

using namespace session;  // what the commands do; what they say is here

/// The command line is at fault: exit code 2.
class UsageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The scene, and the changes to it: shared by render, plan and info.
struct SceneArguments {
    std::string scene;
    std::string integrator;
    std::vector<std::string> defines;  ///< "name=value"
    bool lenient = false;
    std::optional<int> frame = {};          ///< of a sequence
    std::vector<std::string> plugins = {};  ///< files
};

struct InfoArguments {
    std::string file;
    bool lenient = false;                   ///< of a scene
    std::vector<std::string> plugins = {};  ///< files
};

/// State that the frames of a sequence share.
struct SequenceFrame {
    std::shared_ptr<const core::Registry> registry;  ///< of all frames: it keeps meshes that do not change
    std::optional<SceneArguments> previous = {};     ///< the frame before; the first has none
    std::shared_ptr<const core::PreviousFrame> before = {};  ///< that frame; null: not loaded yet
    std::optional<LoadedScene> rendered = {};                ///< this frame, when it is finished
};

struct MergedFilm;

struct RenderArguments {
    SceneArguments scene;
    std::string output;  ///< "": the scene's name with .exr, in the current folder
    std::optional<std::uint32_t> passes;
    std::optional<double> seconds, noise, error;
    std::uint64_t seed = 0;
    int threads = 0;  ///< 0: one for every core
    bool resume = false, quiet = false, verbose = false, half = false, auxiliary = false;
    std::string denoise;  ///< "oidn" or "bmfr"; "": not denoised
    double checkpoint_every = 60.0;
    std::optional<float> exposure;  ///< of the preview [stops]; none: it adapts
    std::string stats;
    std::string tev;                     ///< address of a viewer; "": none
    std::string pass_range;              ///< "A:B": only these passes, into a partial film; "": a picture
    bool identity = false;               ///< print what partial films must have in common, and render nothing
    const MergedFilm* merged = nullptr;  ///< passes that are there already (`mote merge`)
    SequenceFrame* sequence = nullptr;   ///< a frame that is finished is not rendered again by --resume
    std::vector<std::string> command_line;
};

struct MergeArguments {
    std::vector<std::string> parts;  ///< partial films
    std::string output;              ///< a picture, or a partial film
    std::string scene;               ///< "": where it was when the parts were rendered
    std::string stats;
    int threads = 0;
    bool quiet = false, half = false;
    std::optional<float> exposure;
    std::vector<std::string> command_line;
};

struct ConvertArguments {
    std::string input, output, layer;
    float exposure = 0.0f;
    core::Tone tone = core::linear_tone;  ///< of a PNG file or a film
    double rate = 24.0;                   ///< of a film: frames a second
    bool half = false;
    bool lenient = false;              ///< of a scene
    std::vector<std::string> defines;  ///< of a scene: "camera=NAME", "emission=FACTOR"
};

struct CompareArguments {
    std::string image, reference;
    std::string second;      ///< a reference of another seed; "": none
    std::string layer;       ///< of both, or "A:B", that of the image and that of the reference
    std::string map;         ///< "": none
    std::string difference;  ///< "x4": how much differences are amplified; "": none
    std::string output;      ///< of the difference; "": IMAGE_difference.png in the current folder
    bool json = false;
};

struct ExportArguments {
    SceneArguments scene;
    std::string target = "mitsuba3", output;
    std::uint64_t max_grid_megabytes = 2000;
};

struct ViewArguments {
    std::vector<std::string> files;  ///< a scene, or pictures
    SceneArguments scene;            ///< without its file
    std::string reference;           ///< a picture; "": none
    std::uint64_t seed = 0;
    std::uint32_t passes = 0;  ///< 0: the scene's sample_count
    int threads = 0;
    unsigned short port = 0;  ///< 0: one that is free
    std::string bind, token;  ///< "": the loopback address, a random token
    bool no_browser = false;
};

/// Throws UsageError for a malformed definition.
SceneChanges scene_changes(const SceneArguments& arguments);
/// Values of a repeatable option, as names and values. Throws UsageError for a malformed one.
std::vector<std::pair<std::string, std::string>> split_defines(const std::vector<std::string>& defines,
                                                               const std::string& option = "-D");
/// Loads the scene with everything that the command line changes, by `registry` or, where that is null, by
/// one of its own. Throws InputError, or UsageError for a malformed definition.
LoadedScene load(const SceneArguments& arguments, std::shared_ptr<const core::Registry> registry = nullptr);
/// Prints everything that is worth a warning, such as what --lenient left out, a line each on stderr.
void warn_about(const LoadedScene& scene);

int render_command(const RenderArguments& arguments);
/// A picture for every value of the -D that runs, where the output holds #### (sequence.h).
int render_sequence(const RenderArguments& arguments);
int merge_command(const MergeArguments& arguments);
int plan_command(const SceneArguments& arguments);
int info_command(const InfoArguments& arguments);
int convert_command(const ConvertArguments& arguments);
/// The part of it that makes a film of a sequence, and the names of such films.
int convert_sequence(const ConvertArguments& arguments);
bool is_film(const std::string& extension);
/// The part of it that turns a glTF or pbrt scene into XML.
int convert_scene(const ConvertArguments& arguments);
int compare_command(const CompareArguments& arguments);
int export_command(const ExportArguments& arguments);
int formats_command(const std::vector<std::string>& plugins);
int view_command(const ViewArguments& arguments);

}  // namespace mote::apps
