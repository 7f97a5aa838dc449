// Text of a partial film about its render, written (merge_partials.cpp reads it): JSON, so that the cluster's
// front end can read it as well.
#include "apps/partial_render.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/render/partial_film.h"
#include "session/render_report.h"

namespace mote::apps {

namespace {

using nlohmann::json;

json statistics_of(const core::Statistics& s) {
    json values = json::object();
    for (const auto& [name, value] : s.values)
        if (std::isfinite(value)) values[name] = value;
    return {{"rays", s.rays},
            {"lookups", s.lookups},
            {"seconds", s.seconds},
            {"values", values},
            {"warnings", s.warnings},
            {"non_finite_samples", s.non_finite_samples},
            {"clamped", s.clamped_samples}};
}

json about(const MergedFilm& m) {
    const RenderArguments& a = m.render;
    return {{"mote", MOTE_VERSION},
            {"commit", git_hash()},
            {"scene", a.scene.scene},
            {"requested_integrator", a.scene.integrator},
            {"defines", a.scene.defines},
            {"lenient", a.scene.lenient},
            {"plugins", a.scene.plugins},
            {"auxiliary", a.auxiliary},
            {"denoise", a.denoise},
            {"half", a.half},
            {"seed", a.seed},
            {"integrator", m.integrator},
            {"content", m.content_hash},
            {"passes", {m.first, m.end}},
            {"statistics", statistics_of(m.statistics)}};
}

}  // namespace

std::string identity_json(const RenderArguments& render, const LoadedScene& scene,
                          const std::string& content_hash) {
    std::size_t parts = 1;
    for (const core::Layer& layer : scene.integrator().layers(scene.scene()))
        parts = std::max(parts, layer.part + 1);
    const json j = {{"mote", MOTE_VERSION},
                    {"commit", git_hash()},
                    {"seed", render.seed},
                    {"integrator", scene.integrator().type()},
                    {"content", content_hash},
                    {"parts", parts},
                    {"sample_count", scene.scene().film().sample_count}};
    return j.dump() + "\n";
}

void write_partial(const std::string& path, const MergedFilm& partial) {
    // File names need not be UTF-8.
    core::write_partial_film(
        path, {about(partial).dump(-1, ' ', false, json::error_handler_t::replace), *partial.film});
}

}  // namespace mote::apps
