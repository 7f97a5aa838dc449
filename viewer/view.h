// Content of the page: a scene that is rendered while its parameters change, or pictures from files.
//
// The page sends JSON (docs/viewer.md lists the messages), and so is every answer; pictures follow as binary
// messages (frame.h). A client gets the next frame of a picture once it has confirmed the one before: a slow
// one gets fewer, and one that is gone costs nothing.
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "core/formats/xml/scene_element.h"
#include "viewer/comparison.h"
#include "viewer/live_render.h"
#include "viewer/message.h"
#include "viewer/task_queue.h"

namespace mote::viewer {

/// Names of renders.
inline const std::string first_render = "A", second_render = "B";

struct ViewSettings {
    session::SceneChanges changes;
    std::uint64_t seed = 0;
    std::uint32_t passes = 0;  ///< 0: the scene's sample_count
    int threads = 0;           ///< 0: one for every core
};

class View {
  public:
    /// Sends to a client; called in any thread, returns at once.
    using Send = std::function<void(int client, const SharedMessage&)>;
    /// `page`: writer of comparisons.
    explicit View(Send send, std::unique_ptr<const ComparisonPage> page = std::make_unique<ComparisonPage>());
    ~View();
    View(const View&) = delete;
    View& operator=(const View&) = delete;

    /// Renders a scene from now on; `settings` has its changes, those of the integrator included.
    void show_scene(const session::LoadedScene& scene, const ViewSettings& settings);
    void show_picture(const std::string& name, const core::ImageChannels& image);
    /// Also shows it; live pictures are measured against it. Throws InputError for values that are not
    /// finite.
    void set_reference(const std::string& name, const core::ImageChannels& image);

    void leave(int client);
    /// Answers; pictures follow from "hello" on. Never throws: the sender of a wrong message receives the
    /// reason.
    void receive(int client, std::string_view text);
    /// The last picture of this name; null: none yet.
    SharedPicture picture(const std::string& name) const;

  private:
    /// A picture that clients can see.
    struct Shown {
        std::optional<Wish> wish;  ///< of a render; none: of a file
        SharedPicture picture;     ///< null: none yet
        std::uint64_t version = 0;
        SharedMessage frame;             ///< of this version; null: not encoded yet
        std::vector<ErrorPoint> errors;  ///< of the last change, against the reference
        /// Of the picture; nothing where it is not known.
        std::optional<ErrorPoint> error() const {
            const bool has = picture && !errors.empty() && errors.back().seconds == picture->seconds;
            return has ? std::optional(errors.back()) : std::nullopt;
        }
    };
    struct Client {
        std::map<std::string, std::uint64_t> sent;       ///< version of each picture
        std::map<std::string, std::uint64_t> confirmed;  ///< by the client
    };

    LiveRender::Reports reports_of(const std::string& name);
    void greet(int client);
    void handle(int client, const nlohmann::json& message);
    void set_values(const nlohmann::json& message);
    void move_camera(const nlohmann::json& message);
    void set_second(const nlohmann::json& message);
    void answer_pixel(int client, const nlohmann::json& message);
    void answer_lights(int client, const nlohmann::json& message);
    void answer_reproduce(int client, const nlohmann::json& message);
    void answer_save(int client, const nlohmann::json& message);
    void answer_compare(int client);
    void confirm(int client, const nlohmann::json& message);
    void stop_all();
    void start_all();
    void take(const std::string& name, const SharedPicture& picture);
    void send_frames(int client);
    void broadcast(const nlohmann::json& message);
    nlohmann::json scene_message() const;
    nlohmann::json frame_header(const std::string& name, const LivePicture& picture,
                                const std::optional<ErrorPoint>& point) const;
    const Shown& find(const std::string& name) const;
    Shown shown(const std::string& name) const;
    session::LoadedScene scene_of(const Shown& shown) const;
    core::Element elements_of(const Wish& wish) const;
    void require_knob(const std::string& path, const Wish& wish) const;
    std::vector<std::string> command_of(const Wish& wish, std::optional<std::uint32_t> passes) const;
    std::string exr_bytes(const LivePicture& picture) const;
    int threads_of(const Wish& wish) const;
    void later(int client, std::function<void()> task);

    Send send_;
    std::unique_ptr<const ComparisonPage> page_;
    std::optional<session::LoadedScene> scene_;  ///< without changes to its integrator
    std::optional<Reference> reference_;
    mutable std::mutex mutex_;  // guards what follows
    std::map<std::string, Shown> pictures_;
    std::vector<std::string> order_;  ///< of the names of pictures
    std::map<int, Client> clients_;
    std::atomic<int> watching_{0};  ///< number of clients
    std::map<std::string, std::unique_ptr<LiveRender>> renders_;
    TaskQueue tasks_;  // ends before the renders, which its tasks use
};

}  // namespace mote::viewer
