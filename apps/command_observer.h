// Observer of a render by the command line: progress, signals, preview file and viewer.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "apps/interruption.h"
#include "apps/progress_line.h"
#include "apps/render_files.h"
#include "apps/tev_viewer.h"

namespace mote::apps {

/// True where an output is a pipe, which waits for its reader.
bool waits_for_reader(const RenderFiles& files);

/// All references must outlive it.
class CommandObserver : public RenderObserver {
  public:
    CommandObserver(const RenderArguments& arguments, const RenderFiles& files, const LoadedScene& scene,
                    int threads, Interruption& interruption);
    ~CommandObserver() override { line_.end(); }

    void progress(const core::RenderProgress& p) override { line_.update(p); }
    bool cancelled() override { return interruption_.signal_number() != 0; }
    bool wants_previews() const override { return !preview_file_.empty() || viewer_; }
    void preview(const core::ImageChannels& image) override;
    /// Without progress, previews are for a look into a long render, if there is a file for them. With a
    /// limit of time they are made as always, since they measure how long the denoiser will take.
    bool preview_is_seen() const override;
    /// Where a picture of the whole is shown already, no part of it takes its place.
    bool previews_are_whole() const override { return showed_whole_; }
    /// At half the resolution, before the first pass, where it is worth its time.
    void show_coarse(const RenderSettings& settings);
    void warning(const std::string& text) override;
    void building_is_over() override;
    /// The last line of progress ends, and the viewer receives the final picture.
    void end(const Rendered& rendered);

  private:
    void show(std::vector<core::Rgb> picture);

    const RenderArguments& arguments_;
    const LoadedScene& scene_;
    const std::string preview_file_;
    Interruption& interruption_;
    ProgressLine line_;
    std::optional<TevViewer> viewer_;
    bool showed_whole_ = false;
    const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace mote::apps
