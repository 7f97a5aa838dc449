// hdrfilm; rfilters box, tent and gaussian; samplers independent and sobol.
#include "core/cameras/film_objects.h"

#include "core/objects/properties.h"
#include "core/objects/registry.h"

namespace mote::core {
namespace {

// 65536 on a side and 2^28 pixels in all: what a film's memory is checked against before it is taken.
constexpr std::int64_t max_side = 65536, max_pixels = std::int64_t(1) << 28;

int get_int_in(const Properties& p, const std::string& name, std::int64_t default_value, std::int64_t lower,
               std::int64_t upper) {
    const std::int64_t value = p.get_int(name, default_value);
    if (value < lower || value > upper)
        throw InputError("'" + name + "' is " + std::to_string(value) + " but must lie between " +
                             std::to_string(lower) + " and " + std::to_string(upper),
                         p.where_of(name));
    return int(value);
}

std::shared_ptr<Object> make_film(const Properties& p) {
    auto film = std::make_shared<FilmObject>();
    film->width = get_int_in(p, "width", film->width, 1, max_side);
    film->height = get_int_in(p, "height", film->height, 1, max_side);
    if (std::int64_t(film->width) * film->height > max_pixels)
        throw InputError("a film has at most 2^28 pixels", p.where);
    film->half = p.get_choice("component_format", "float32", {"float16", "float32"}) == "float16";
    if (const auto filter = p.child_of<FilterObject>(Category::rfilter)) film->filter = *filter;
    return film;
}

Factory filter_factory(const std::string& name, float default_radius) {
    return [name, default_radius](const Properties& p) {
        auto filter = std::make_shared<FilterObject>();
        filter->name = name;
        filter->radius = default_radius;
        if (name == "gaussian") {
            filter->stddev = float(p.get_float_in("stddev", 0.5, 1e-3, 16.0));
            filter->radius = 4.0f * filter->stddev;
        } else if (name == "tent") {
            filter->radius = float(p.get_float_in("radius", double(default_radius), 1e-3, 64.0));
        }
        return filter;
    };
}

Factory sampler_factory(const std::string& kind) {
    return [kind](const Properties& p) {
        auto sampler = std::make_shared<SamplerObject>();
        sampler->kind = kind;
        sampler->sample_count =
            get_int_in(p, "sample_count", sampler->sample_count, 1, std::int64_t(1) << 30);
        return sampler;
    };
}

Parameter sample_count() {
    return {"sample_count", "integer", "16",
            "passes, one sample per pixel each, when the command line does not say"};
}

}  // namespace

FilmObject film_of_sensor(const Properties& properties) {
    const auto film = properties.child_of<FilmObject>(Category::film);
    return film ? *film : FilmObject();
}

FilmSettings film_settings(const Properties& sensor) {
    const FilmObject film = film_of_sensor(sensor);
    FilmSettings settings;
    settings.width = film.width, settings.height = film.height;
    settings.half = film.half;
    settings.filter = film.filter.name;
    settings.filter_radius = film.filter.radius, settings.filter_stddev = film.filter.stddev;
    if (const auto sampler = sensor.child_of<SamplerObject>(Category::sampler)) {
        settings.sampler = sampler->kind;
        settings.sample_count = sampler->sample_count;
    }
    return settings;
}

void register_film_objects(Registry& registry) {
    registry.add({Category::film,
                  "hdrfilm",
                  "The picture: its size, filter and format.",
                  {{"width", "integer", "768", "pixels"},
                   {"height", "integer", "576", "pixels"},
                   {"component_format", "string", "float32", "float32, or float16 for half the size"},
                   {"rfilter", "rfilter", "gaussian", "reconstruction filter"}},
                  R"(<film type="hdrfilm"><integer name="width" value="640"/><rfilter type="box"/></film>)"},
                 make_film);
    registry.add({Category::rfilter,
                  "box",
                  "A pixel is the mean over its square: the filter for comparing pictures.",
                  {},
                  R"(<rfilter type="box"/>)"},
                 filter_factory("box", 0.5f));
    registry.add({Category::rfilter,
                  "tent",
                  "Falls off linearly to zero at the radius.",
                  {{"radius", "float", "1", "pixels"}},
                  R"(<rfilter type="tent"><float name="radius" value="1"/></rfilter>)"},
                 filter_factory("tent", 1.0f));
    registry.add({Category::rfilter,
                  "gaussian",
                  "A Gaussian cut off at four standard deviations.",
                  {{"stddev", "float", "0.5", "standard deviation, pixels"}},
                  R"(<rfilter type="gaussian"><float name="stddev" value="0.5"/></rfilter>)"},
                 filter_factory("gaussian", 2.0f));
    registry.add({Category::sampler,
                  "independent",
                  "Independent random numbers.",
                  {sample_count()},
                  R"(<sampler type="independent"><integer name="sample_count" value="64"/></sampler>)"},
                 sampler_factory("independent"));
    registry.add({Category::sampler,
                  "sobol",
                  "Owen-scrambled Sobol points (Burley 2020): less noise for the same passes.",
                  {sample_count()},
                  R"(<sampler type="sobol"><integer name="sample_count" value="64"/></sampler>)"},
                 sampler_factory("sobol"));
}

}  // namespace mote::core
