// hdrfilm; rfilters box, tent and gaussian; samplers independent and sobol.
#include "core/cameras/film_objects.h"

namespace mote::core {
namespace {

// 65536 on a side and 2^28 pixels in all: what a film's memory is checked against before it is taken.
constexpr std::int64_t max_side = 65536, max_pixels = std::int64_t(1) << 28;

std::shared_ptr<Object> make_film(const FilmFormat& film, const Properties& p) {
    if (std::int64_t(film.width) * film.height > max_pixels)
        throw InputError("a film has at most 2^28 pixels", p.where);
    return std::make_shared<SettingsObject<FilmFormat>>(film);
}

void register_filters(Registry& registry) {
    using S = FilterSettings;
    const auto add = [&](const S& defaults, std::initializer_list<Rows<S>> rows, const std::string& summary,
                         const std::string& example) {
        add_type(registry, Category::rfilter, defaults.name, summary, ParameterList<S>(defaults, rows),
                 example, [](S s) {
                     if (s.name == "gaussian") s.radius = 4.0f * s.stddev;
                     return std::make_shared<SettingsObject<S>>(s);
                 });
    };
    add({"box", 0.5f}, {}, "A pixel is the mean over its square: the filter for comparing pictures.",
        R"(<rfilter type="box"/>)");
    add({"tent", 1.0f},
        {row("radius", &S::radius, between(1e-3, 64, "pixels"), "Half the width of the filter.")},
        "Falls off linearly to zero at the radius.",
        R"(<rfilter type="tent"><float name="radius" value="1"/></rfilter>)");
    add({}, {row("stddev", &S::stddev, between(1e-3, 16, "pixels"), "Standard deviation.")},
        "A Gaussian cut off at four standard deviations.",
        R"(<rfilter type="gaussian"><float name="stddev" value="0.5"/></rfilter>)");
}

void register_samplers(Registry& registry) {
    using S = SamplerSettings;
    const auto add = [&](const std::string& kind, const std::string& summary) {
        S defaults;
        defaults.kind = kind;
        add_type(
            registry, Category::sampler, kind, summary,
            ParameterList<S>(defaults,
                             {row("sample_count", &S::sample_count, between(1, 1 << 30),
                                  "Passes, one sample per pixel each, when the command line does not say.")}),
            "<sampler type=\"" + kind + R"("><integer name="sample_count" value="64"/></sampler>)");
    };
    add("independent", "Independent random numbers.");
    add("sobol", "Owen-scrambled Sobol points (Burley 2020): less noise for the same passes.");
}

}  // namespace

void register_film_objects(Registry& registry) {
    using S = FilmFormat;
    add_type<S>(
        registry, Category::film, "hdrfilm", "The image: its size, filter and format.",
        {row("width", &S::width, between(1, max_side, "pixels"), "Width of the image."),
         row("height", &S::height, between(1, max_side, "pixels"), "Height of the image."),
         row("component_format", &S::half, {{"float32", false}, {"float16", true}},
             "Numbers in the file: float16 takes half the size."),
         row("interval", &S::interval,
             "State the error, bias of filters included, with an interval of 95 % confidence, where "
             "the method allows it. The passes are two independent halves, and filters work on each; of "
             "`mote_vpl` eight groups, beside paths for the light that is missing."),
         nested("rfilter", &S::filter, Category::rfilter, "gaussian", "Reconstruction filter.")},
        R"(<film type="hdrfilm"><integer name="width" value="640"/><rfilter type="box"/></film>)", make_film);
    register_filters(registry);
    register_samplers(registry);
}

}  // namespace mote::core
