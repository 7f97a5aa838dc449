// A render that is changed while it runs: a coarse picture first, then passes, until the wish changes.
//
// One thread calls session::render() for the present wish; a newer one ends that call. What belongs to the
// integrator alone is made anew without loading the scene; everything else loads it again, by a registry that
// keeps its meshes.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "session/loaded_scene.h"
#include "session/render.h"

namespace mote::viewer {

/// The picture that is wanted.
struct Wish {
    session::SceneChanges changes;
    std::uint64_t seed = 0;
    std::uint32_t passes = 0;  ///< 0: the scene's sample_count
    int threads = 0;           ///< 0: one for every core
    bool moving = false;       ///< the coarse picture alone, for the next wish is on its way
};

/// A picture on its way to that.
struct LivePicture {
    core::ImageChannels image;  ///< as a file has it
    Wish wish;
    std::uint32_t passes = 0;  ///< that `mote render` makes the same bits with; 0: none
    double seconds = 0.0;      ///< of this render, since its change
    double noise = 0.0;        ///< infinity: not known
    bool coarse = false;       ///< of fewer pixels than the film has
    bool finished = false;     ///< no more passes follow
    std::uint64_t change = 0;  ///< number of the wish
};
using SharedPicture = std::shared_ptr<const LivePicture>;

class LiveRender {
  public:
    /// Receives reports, in the thread of the render.
    struct Reports {
        std::function<void(const SharedPicture&)> picture;
        std::function<void(std::uint64_t change, const core::RenderProgress&)> progress;
        std::function<void(std::uint64_t change, const std::string& why)> problem;
        std::function<bool()> is_seen;  ///< false: no picture is made before the last one
    };
    LiveRender(const session::LoadedScene& scene, Reports reports);
    ~LiveRender();
    LiveRender(const LiveRender&) = delete;
    LiveRender& operator=(const LiveRender&) = delete;

    /// Replaces the wish; returns its number.
    std::uint64_t render(const Wish& wish);
    /// Ends the passes; what there is is the picture.
    void stop();
    /// The scene as the last picture shows it. Throws InputError.
    session::LoadedScene scene_for(const session::SceneChanges& changes);

  private:
    class Observer;
    void run();
    void show(const Wish& wish, std::uint64_t change);
    void show_coarse(const Wish& wish, std::uint64_t change);
    double show_at_size(const Wish& wish, std::uint64_t change, const session::LoadedScene& loaded, int width,
                        int height);
    void adapt(double seconds);
    void show_full(const Wish& wish, std::uint64_t change);
    void report(session::Rendered&& rendered, const Wish& wish, std::uint64_t change, bool coarse,
                double seconds) const;
    bool is_superseded(std::uint64_t change) const { return change_.load() != change; }

    Reports reports_;
    std::mutex scene_mutex_;
    std::optional<session::LoadedScene> scene_;         ///< of the last load; guarded
    std::size_t coarse_pixels_ = 8192;                  ///< adapts to the time that they take
    std::optional<session::LoadedScene> coarse_scene_;  ///< of the last coarse picture
    std::mutex mutex_;
    std::condition_variable changed_;
    Wish wish_;                             ///< guarded
    bool quit_ = false;                     ///< guarded
    std::atomic<std::uint64_t> change_{0};  ///< number of `wish_`
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

}  // namespace mote::viewer
