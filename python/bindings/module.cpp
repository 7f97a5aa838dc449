// The extension module mote._mote: what the package `mote` is written on. Only the package should use it.
#include "core/formats/xml/faults.h"
#include "core/objects/memory_budget.h"
#include "python/bindings/bindings.h"
#include "session/render_report.h"

namespace mote::python {

std::vector<core::Rgb> colours(const Pixels& pixels) {
    if (pixels.shape(2) != 3) throw std::invalid_argument("a picture has three channels: [row][column][3]");
    std::vector<core::Rgb> rgb(pixels.shape(0) * pixels.shape(1));
    for (std::size_t i = 0; i < rgb.size(); ++i)
        rgb[i] = {pixels.data()[3 * i], pixels.data()[3 * i + 1], pixels.data()[3 * i + 2]};
    return rgb;
}

namespace {

/// An instance of mote.Error, with all that is wrong in `errors`: (text, file, line).
nb::object error_object(nb::handle type, const core::InputError& error) {
    nb::object made = type(error.what());
    const auto* several = dynamic_cast<const core::SceneErrors*>(&error);
    const core::InputError& first = several ? several->all().front() : error;
    nb::list all;
    if (several)
        for (const core::InputError& e : several->all())
            all.append(nb::make_tuple(e.what(), e.where().file, e.where().line));
    else
        all.append(nb::make_tuple(error.what(), error.where().file, error.where().line));
    made.attr("file") = first.where().file;
    made.attr("line") = first.where().line;
    made.attr("errors") = all;
    return made;
}

}  // namespace

void bind_errors(nb::module_& m) {
    m.def(
        "register_error",
        [](nb::object type) {
            nb::register_exception_translator(
                [](const std::exception_ptr& thrown, void* payload) {
                    try {
                        std::rethrow_exception(thrown);
                    } catch (const core::InputError& error) {
                        const nb::handle error_type(static_cast<PyObject*>(payload));
                        PyErr_SetObject(error_type.ptr(), error_object(error_type, error).ptr());
                    }
                },
                type.release().ptr());
        },
        nb::arg("type"), "What InputError becomes. Called once, by the package.");
}

}  // namespace mote::python

NB_MODULE(_mote, m) {
    using namespace mote;
    m.attr("version") = MOTE_VERSION;
    m.attr("git_hash") = session::git_hash();
    m.def(
        "require_memory",
        [](double bytes, const std::string& purpose) { core::MemoryBudget().require(bytes, purpose); },
        nanobind::arg("bytes"), nanobind::arg("purpose"), "Raises MemoryError where there is no room.");
    python::bind_errors(m);
    python::bind_scenes(m);
    python::bind_pictures(m);
    python::bind_rendering(m);
    python::bind_viewing(m);
    python::bind_algorithms(m);
    python::bind_host_light(m);
}
