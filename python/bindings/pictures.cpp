// Pictures: layers, files, previews; and what is measured of them and done to them.
#include <cmath>

#include "core/film/exposure.h"
#include "core/formats/meshes/text_scanner.h"
#include "core/formats/pictures/image_file.h"
#include "core/math/srgb.h"
#include "core/metrics/series_error.h"
#include "python/bindings/bindings.h"
#include "session/borrowed_arena.h"
#include "session/compare.h"
#include "session/denoise/bmfr_sequence.h"
#include "session/denoise/denoised_layer.h"
#include "session/output_files.h"
#include "session/picture_compensation.h"

namespace mote::python {

namespace {

/// [row][column][channel] in memory that Python owns; of one channel [row][column].
nb::object read_layer(const Picture& picture, const std::string& name) {
    const core::ImageChannels& image = picture.rendered.image;
    const session::LayerChannels layer = session::find_layer(image, name);
    const std::size_t height = std::size_t(image.height), width = std::size_t(image.width),
                      n = layer.planes.size();
    auto* values = new std::vector<float>(height * width * n);
    const nb::capsule owner(values, [](void* p) noexcept { delete static_cast<std::vector<float>*>(p); });
    session::copy_layer(image, layer, *values);
    if (n == 1) return nb::cast(nb::ndarray<nb::numpy, float>(values->data(), {height, width}, owner));
    return nb::cast(nb::ndarray<nb::numpy, float>(values->data(), {height, width, n}, owner));
}

void write_layer(Picture& picture, const std::string& name, const Pixels& values) {
    session::set_layer(picture.rendered.image, name, int(values.shape(1)), int(values.shape(0)),
                       int(values.shape(2)), std::span(values.data(), values.size()));
}

/// A layer of colours as 8-bit sRGB, row by row; none: the exposure adapts to the picture.
std::vector<std::uint8_t> srgb_bytes(const Picture& picture, const std::string& layer,
                                     std::optional<float> exposure) {
    const core::ImageChannels& image = picture.rendered.image;
    const std::vector<core::Rgb> pixels = image.rgb(layer == session::beauty_layer ? "" : layer);
    if (pixels.empty()) throw core::InputError("'" + core::printable(layer) + "' is no layer of R, G and B");
    const float scale = std::exp2(exposure ? *exposure : core::adapted_exposure(pixels));
    std::vector<std::uint8_t> bytes;
    for (const core::Rgb& p : pixels)
        for (int c = 0; c < 3; ++c)
            bytes.push_back(core::encode_srgb(std::isfinite(p[c]) ? scale * p[c] : 0.0f));
    return bytes;
}

nb::object srgb(const Picture& picture, const std::string& layer, std::optional<float> exposure) {
    auto* bytes = new std::vector<std::uint8_t>(srgb_bytes(picture, layer, exposure));
    const nb::capsule owner(bytes,
                            [](void* p) noexcept { delete static_cast<std::vector<std::uint8_t>*>(p); });
    const core::ImageChannels& image = picture.rendered.image;
    return nb::cast(nb::ndarray<nb::numpy, std::uint8_t>(
        bytes->data(), {std::size_t(image.height), std::size_t(image.width), 3}, owner));
}

nb::bytes png(const Picture& picture, const std::string& layer, std::optional<float> exposure) {
    const core::ImageChannels& image = picture.rendered.image;
    const std::vector<std::byte> file =
        core::encode_png(image.width, image.height, srgb_bytes(picture, layer, exposure), true);
    return nb::bytes(file.data(), file.size());
}

std::vector<std::pair<std::string, std::vector<std::string>>> layers(const Picture& picture) {
    std::vector<std::pair<std::string, std::vector<std::string>>> result;
    for (const session::LayerChannels& layer : session::layers_of(picture.rendered.image))
        result.emplace_back(layer.name, layer.channels);
    return result;
}

nb::dict metrics(const core::ImageMetrics& m) {
    nb::dict d;
    for (const core::MetricDefinition& definition : core::metric_definitions())
        d[definition.name] = m.*definition.value;
    d["mean_image"] = m.average_image, d["mean_reference"] = m.average_reference;
    d["non_finite"] = m.non_finite_either;
    return d;
}

nb::dict compare(const Pixels& image, const Pixels& reference, const std::optional<Pixels>& image_variance,
                 const std::optional<Pixels>& reference_variance, const std::optional<Pixels>& second,
                 const std::optional<Pixels>& second_variance) {
    const auto given = [](const std::optional<Pixels>& p) {
        return p ? colours(*p) : std::vector<core::Rgb>();
    };
    const auto a = colours(image), r = colours(reference), a_variance = given(image_variance),
               r_variance = given(reference_variance), s = given(second), s_variance = given(second_variance);
    const int width = int(image.shape(1)), height = int(image.shape(0));
    if (reference.shape(0) != image.shape(0) || reference.shape(1) != image.shape(1))
        throw std::invalid_argument("image and reference have different shapes");
    core::ImageMetrics m;
    {
        const nb::gil_scoped_release without_gil;
        if (!second) {
            m = session::measure({a, a_variance}, {r, r_variance}, width, height);
        } else {
            const core::ReferencePair pair{r, s, r_variance, s_variance};
            m = session::measure({a, a_variance}, pair, core::mean_of(pair), width, height);
        }
    }
    return metrics(m);
}

/// One reference or two, their variances where known, and the pixels that count.
core::ErrorMeasure measure_of(const Pixels& reference, const std::optional<Pixels>& variance,
                              const std::optional<Pixels>& second,
                              const std::optional<Pixels>& second_variance, const std::optional<Mask>& mask) {
    const auto given = [](const std::optional<Pixels>& p) {
        return p ? colours(*p) : std::vector<core::Rgb>();
    };
    const int width = int(reference.shape(1)), height = int(reference.shape(0));
    if (mask && (mask->shape(0) != reference.shape(0) || mask->shape(1) != reference.shape(1)))
        throw std::invalid_argument("mask and reference have different shapes");
    const auto counted = mask ? std::span(mask->data(), mask->size()) : std::span<const std::uint8_t>();
    const auto r = colours(reference), r_variance = given(variance);
    if (!second) return {r, r_variance, width, height, counted};
    const auto s = given(second), s_variance = given(second_variance);
    return {core::ReferencePair{r, s, r_variance, s_variance}, width, height, counted};
}

nb::dict series_error(const std::vector<Pixels>& images, const core::ErrorMeasure& measure) {
    std::vector<std::vector<core::Rgb>> pictures;
    for (const Pixels& image : images) pictures.push_back(colours(image));
    core::SeriesError e;
    {
        const nb::gil_scoped_release without_gil;
        e = measure.measure(pictures);
    }
    nb::dict d;
    d["error"] = e.error, d["error_standard_error"] = e.error_standard_error;
    d["squared_error"] = e.squared_error, d["bias"] = e.bias;
    d["bias_standard_error"] = e.bias_standard_error, d["systematic"] = e.systematic;
    d["systematic_standard_error"] = e.systematic_standard_error, d["noise"] = e.noise;
    return d;
}

nb::object pixel_errors(const Pixels& image, const core::ErrorMeasure& measure) {
    auto* values = new std::vector<double>(measure.pixel_errors(colours(image)));
    const nb::capsule owner(values, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
    return nb::cast(nb::ndarray<nb::numpy, double>(values->data(), {image.shape(0), image.shape(1)}, owner));
}

void compensate(Picture& picture, float bound, int steps, bool flat, bool half_resolution, float blur,
                bool replace) {
    screenspace::SsbcSettings settings;
    settings.bound = bound, settings.steps = steps, settings.hierarchical = !flat;
    settings.half_resolution = half_resolution, settings.blur = blur;
    const nb::gil_scoped_release without_gil;
    session::compensate_picture(picture.rendered.image, settings, {}, replace);
}

/// State of the frames so far.
struct Sequence {
    session::BmfrSequence frames{false};
};

Picture read_picture(const std::string& path) {
    const nb::gil_scoped_release without_gil;
    Picture picture;
    picture.rendered.image = core::read_exr(path);
    const auto& known = picture.rendered.image.metadata;
    const auto number = [&known](const char* name) {
        const auto found = known.find(name);
        return found == known.end() ? std::nullopt : core::TextScanner::parse_number(found->second);
    };
    if (const auto passes = number("passes"); passes && *passes >= 0.0 && *passes <= 4294967295.0)
        picture.rendered.passes = std::uint32_t(*passes);
    if (const auto noise = number("noise"); noise && *noise >= 0.0) picture.rendered.noise = *noise;
    picture.rendered.interrupted = known.contains("partOfFirstPass");
    return picture;
}

}  // namespace

void bind_pictures(nb::module_& m) {
    nb::class_<Picture>(m, "Picture", "Layers and what is known of them.")
        .def(nb::init<>())
        .def("copy", [](const Picture& p) { return Picture(p); })
        .def_static("read", &read_picture, nb::arg("path"))
        .def(
            "save",
            [](const Picture& p, const std::string& path, bool half) {
                const nb::gil_scoped_release without_gil;
                session::require_exr_name(path);
                core::write_exr(path, p.rendered.image, half);
            },
            nb::arg("path"), nb::arg("half"))
        .def_prop_ro("width", [](const Picture& p) { return p.rendered.image.width; })
        .def_prop_ro("height", [](const Picture& p) { return p.rendered.image.height; })
        .def_prop_ro("passes", [](const Picture& p) { return p.rendered.passes; })
        .def_prop_ro("noise", [](const Picture& p) { return p.rendered.noise; })
        .def_prop_ro("interrupted", [](const Picture& p) { return p.rendered.interrupted; })
        .def_prop_ro("statistics", [](const Picture& p) { return p.rendered.statistics; })
        .def_prop_ro("warnings", [](const Picture& p) { return p.rendered.warnings; })
        .def_prop_ro("metadata", [](const Picture& p) { return p.rendered.image.metadata; })
        .def(
            "set_metadata",
            [](Picture& p, const std::string& name, const std::string& text) {
                p.rendered.image.metadata[name] = text;
            },
            nb::arg("name"), nb::arg("text"))
        .def("layers", &layers)
        .def("read_layer", &read_layer, nb::arg("name"))
        .def("write_layer", &write_layer, nb::arg("name"), nb::arg("values"))
        .def("srgb", &srgb, nb::arg("layer"), nb::arg("exposure").none())
        .def("png", &png, nb::arg("layer"), nb::arg("exposure").none())
        .def("compensate", &compensate, nb::arg("bound"), nb::arg("steps"), nb::arg("flat"),
             nb::arg("half_resolution"), nb::arg("blur"), nb::arg("replace"))
        .def(
            "denoise",
            [](Picture& p, const std::string& method, int threads, const std::string& oidn_package) {
                const nb::gil_scoped_release without_gil;
                session::BorrowedArena(threads).execute(
                    [&] { session::make_denoiser(method, threads, false, oidn_package)(p.rendered.image); });
            },
            nb::arg("method"), nb::arg("threads"), nb::arg("oidn_package"));
    nb::class_<Sequence>(m, "Sequence", "Frames that are denoised in their order.")
        .def(nb::init<>())
        .def(
            "denoise",
            [](Sequence& s, Picture& p) {
                const nb::gil_scoped_release without_gil;
                s.frames.add_denoised_layer(p.rendered.image);
            },
            nb::arg("picture"));
    m.def("compare", &compare, nb::arg("image"), nb::arg("reference"), nb::arg("image_variance").none(),
          nb::arg("reference_variance").none(), nb::arg("second").none(), nb::arg("second_variance").none());
    nb::class_<core::ErrorMeasure>(m, "ErrorMeasure");
    m.def("error_measure", &measure_of, nb::arg("reference"), nb::arg("variance").none(),
          nb::arg("second").none(), nb::arg("second_variance").none(), nb::arg("mask").none());
    m.def("series_error", &series_error);
    m.def("pixel_errors", &pixel_errors);
    m.def("metric_definitions", [] {
        std::map<std::string, std::string> definitions;
        for (const core::MetricDefinition& d : core::metric_definitions()) definitions[d.name] = d.definition;
        return definitions;
    });
}

}  // namespace mote::python
