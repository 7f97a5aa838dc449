// Rendering: Python's other threads run, its signals are handled, and its exceptions are kept until the
// picture is safe.
#include "python/bindings/bindings.h"

namespace mote::python {

namespace {

nb::dict as_dict(const core::RenderProgress& p) {
    nb::dict d;
    d["passes"] = p.passes, d["passes_of_this_run"] = p.passes_of_this_run;
    d["passes_wanted"] = p.passes_wanted ? nb::object(nb::int_(*p.passes_wanted)) : nb::object(nb::none());
    d["seconds"] = p.seconds, d["noise"] = p.noise;
    d["seconds_left"] =
        p.seconds_left < 0.0 ? nb::object(nb::none()) : nb::object(nb::float_(p.seconds_left));
    return d;
}

/// Calls Python's functions, and keeps the first exception of one: the render then ends as if it were
/// cancelled.
class PythonObserver : public session::RenderObserver {
  public:
    PythonObserver(nb::object progress, nb::object preview)
        : progress_(std::move(progress)), preview_(std::move(preview)) {}

    void progress(const core::RenderProgress& p) override {
        if (!progress_.is_none()) call([&] { return is_false(progress_(as_dict(p))); });
    }
    bool wants_previews() const override { return !preview_.is_none(); }
    void preview(const core::ImageChannels& image) override {
        call([&] {
            Picture picture;
            picture.rendered.image = image;
            return is_false(preview_(nb::cast(std::move(picture))));
        });
    }
    bool cancelled() override {
        call([]() -> bool {
            if (PyErr_CheckSignals() != 0) throw nb::python_error();
            return false;
        });
        return stop_;
    }
    /// The exception; None where there was none.
    nb::object raised() const { return error_; }

  private:
    static bool is_false(const nb::object& answer) { return answer.is(nb::bool_(false)); }
    /// f returns true to stop.
    template <typename F>
    void call(const F& f) {
        if (stop_) return;
        const nb::gil_scoped_acquire ours;
        try {
            stop_ = f();
        } catch (nb::python_error& error) {
            error_ = nb::borrow(error.value());
            stop_ = true;
        }
    }

    nb::object progress_, preview_, error_ = nb::none();
    bool stop_ = false;
};

/// (picture, exception or None): what a signal or a callback raised ends the render, and what there is stays.
nb::tuple render(const session::LoadedScene& scene, std::optional<std::uint32_t> passes,
                 std::optional<double> seconds, std::optional<double> noise, std::optional<double> error,
                 std::uint64_t seed, int threads, const std::string& checkpoint, double checkpoint_every,
                 bool resume, bool auxiliary, const std::string& denoise, const std::string& oidn_package,
                 const std::vector<std::string>& command_line, nb::object progress, nb::object preview) {
    session::RenderSettings settings;
    settings.stop = {passes, seconds, noise, error};
    settings.seed = seed, settings.threads = threads;
    settings.checkpoint = checkpoint, settings.checkpoint_every = checkpoint_every, settings.resume = resume;
    settings.auxiliary = auxiliary, settings.denoise = denoise, settings.oidn_package = oidn_package,
    settings.command_line = command_line;
    PythonObserver observer(std::move(progress), std::move(preview));
    Picture picture;
    {
        const nb::gil_scoped_release without_gil;
        picture.rendered = session::render(scene, settings, observer);
    }
    return nb::make_tuple(nb::cast(std::move(picture)), observer.raised());
}

}  // namespace

void bind_rendering(nb::module_& m) {
    m.def("render", &render, nb::arg("scene"), nb::arg("passes").none(), nb::arg("seconds").none(),
          nb::arg("noise").none(), nb::arg("error").none(), nb::arg("seed"), nb::arg("threads"),
          nb::arg("checkpoint"), nb::arg("checkpoint_every"), nb::arg("resume"), nb::arg("auxiliary"),
          nb::arg("denoise"), nb::arg("oidn_package"), nb::arg("command_line"), nb::arg("progress").none(),
          nb::arg("preview").none());
}

}  // namespace mote::python
