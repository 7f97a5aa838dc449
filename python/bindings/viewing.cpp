// The viewer for a widget: messages go in as text, and wait in a queue until Python's thread takes them.
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>

#include "python/bindings/bindings.h"
#include "viewer/page_files.h"
#include "viewer/view.h"

namespace mote::python {

namespace {

/// A view with one client, the widget. The oldest messages are dropped where too many wait.
class WidgetView {
  public:
    void show_scene(const session::LoadedScene& scene, const std::string& integrator,
                    const std::vector<std::pair<std::string, std::string>>& defines, std::uint32_t passes,
                    std::uint64_t seed, int threads) {
        viewer::ViewSettings settings;
        settings.changes = scene.changes();
        if (!integrator.empty()) settings.changes.integrator = integrator;
        settings.changes.defines.insert(settings.changes.defines.end(), defines.begin(), defines.end());
        settings.passes = passes, settings.seed = seed, settings.threads = threads;
        const nb::gil_scoped_release without_gil;
        view_->show_scene(scene, settings);
    }
    void show_picture(const std::string& name, const Picture& picture) {
        view_->show_picture(name, picture.rendered.image);
    }
    void set_reference(const std::string& name, const Picture& picture) {
        view_->set_reference(name, picture.rendered.image);
    }
    void receive(const std::string& text) {
        const std::shared_ptr<viewer::View> view = view_;  // close() may come meanwhile
        const nb::gil_scoped_release without_gil;
        if (view) view->receive(widget, text);
    }
    /// str, bytes, or None where none came within `seconds`.
    nb::object next_message(double seconds) {
        viewer::SharedMessage message;
        {
            const nb::gil_scoped_release without_gil;
            std::unique_lock lock(mutex_);
            added_.wait_for(lock, std::chrono::duration<double>(seconds),
                            [&] { return closed_ || !messages_.empty(); });
            if (messages_.empty()) return nb::none();
            message = messages_.front();
            messages_.pop_front();
        }
        if (message->binary) return nb::bytes(message->bytes.data(), message->bytes.size());
        return nb::str(message->bytes.data(), message->bytes.size());
    }
    std::optional<Picture> picture(const std::string& name) const {
        const viewer::SharedPicture found = view_ ? view_->picture(name) : nullptr;
        if (!found) return std::nullopt;
        Picture picture;
        picture.rendered.image = found->image, picture.rendered.passes = found->passes;
        picture.rendered.noise = found->noise;
        return picture;
    }
    void close() {
        std::shared_ptr<viewer::View> view = std::move(view_);
        view_.reset();
        const nb::gil_scoped_release without_gil;
        view.reset();
        const std::lock_guard lock(mutex_);
        closed_ = true;
        added_.notify_all();
    }
    bool closed() const { return closed_; }

  private:
    static constexpr int widget = 1;
    static constexpr std::size_t max_messages = 256;

    void add(const viewer::SharedMessage& message) {
        const std::lock_guard lock(mutex_);
        if (messages_.size() >= max_messages) messages_.pop_front();
        messages_.push_back(message);
        added_.notify_one();
    }

    std::mutex mutex_;
    std::condition_variable added_;
    std::deque<viewer::SharedMessage> messages_;
    std::atomic<bool> closed_{false};
    std::shared_ptr<viewer::View> view_ =
        std::make_shared<viewer::View>([this](int, const viewer::SharedMessage& message) { add(message); });
};

}  // namespace

void bind_viewing(nb::module_& m) {
    nb::class_<WidgetView>(m, "View", "The viewer behind a widget.")
        .def(nb::init<>())
        .def("show_scene", &WidgetView::show_scene, nb::arg("scene"), nb::arg("integrator"),
             nb::arg("defines"), nb::arg("passes"), nb::arg("seed"), nb::arg("threads"))
        .def("show_picture", &WidgetView::show_picture, nb::arg("name"), nb::arg("picture"))
        .def("set_reference", &WidgetView::set_reference, nb::arg("name"), nb::arg("picture"))
        .def("receive", &WidgetView::receive, nb::arg("text"))
        .def("next_message", &WidgetView::next_message, nb::arg("seconds"))
        .def("picture", &WidgetView::picture, nb::arg("name"))
        .def("close", &WidgetView::close)
        .def_prop_ro("closed", &WidgetView::closed);
    m.def("page_script", viewer::page_script);
    m.def(
        "page_file",
        [](const std::string& name) {
            const viewer::PageFile* file = viewer::find_page_file(name);
            return std::string(file ? file->text : "");
        },
        nb::arg("name"));
}

}  // namespace mote::python
