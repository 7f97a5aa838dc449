// Many-light methods over a host's rays.
#include "session/host/host_light.h"

#include "plugins/c/handles.h"

using namespace mote;
using c::required, c::vec3;
using core::Rgb;

struct mote_host_light {
    std::unique_ptr<session::HostScene> scene;
    std::unique_ptr<session::HostLight> light;  // refers to the scene
    c::LastError error;
};

namespace {

mote_segment segment_of(const session::HostSegment& s) {
    return {{s.origin.x, s.origin.y, s.origin.z}, {s.direction.x, s.direction.y, s.direction.z}, s.length};
}

session::HostSceneData data_of(const mote_host_options& o) {
    if (!o.first_hit) throw c::InvalidArgument("first_hit() is needed");
    session::HostSceneData data;
    for (std::size_t i = 0; i < o.material_count; ++i)
        data.reflectance.push_back(vec3(&required(o.reflectance, "the reflectance") + 3 * i));
    for (std::size_t i = 0; i < o.lamp_count; ++i) {
        const mote_lamp& lamp = (&required(o.lamps, "the lamps"))[i];
        data.lamps.push_back({{lamp.position[0], lamp.position[1], lamp.position[2]}, vec3(lamp.intensity)});
    }
    data.scattering = vec3(o.scattering), data.absorption = vec3(o.absorption);
    data.anisotropy = float(o.anisotropy);
    data.bounds = {vec3(o.lower), vec3(o.upper)};
    const auto first_hit = o.first_hit;
    const auto find_occluded = o.find_occluded;
    void* const user = o.user;
    data.first_hit = [=](const session::HostSegment& s) -> std::optional<session::HostHit> {
        const mote_segment segment = segment_of(s);
        mote_hit hit = {};
        if (!first_hit(user, &segment, &hit)) return {};
        return session::HostHit{hit.distance, vec3(hit.normal), hit.material};
    };
    if (find_occluded)
        data.find_occluded = [=](std::span<const session::HostSegment> given,
                                 std::span<std::uint8_t> hidden) {
            std::vector<mote_segment> segments;
            segments.reserve(given.size());
            for (const session::HostSegment& s : given) segments.push_back(segment_of(s));
            find_occluded(user, segments.data(), segments.size(), hidden.data());
        };
    return data;
}

session::HostLightSettings settings_of(const mote_host_light_options& o) {
    session::HostLightSettings settings;
    if (o.method) settings.method = session::host_method(o.method);
    if (o.selection) settings.selection = o.selection;
    if (o.paths) settings.paths = o.paths;
    if (o.bound != 0.0) settings.bound = float(o.bound);
    if (o.neighbours) settings.neighbours = o.neighbours;
    settings.compensation_steps = o.compensation_steps, settings.seed = o.seed;
    return settings;
}

}  // namespace

mote_host_light* mote_host_light_new(void) { return new (std::nothrow) mote_host_light; }
void mote_host_light_free(mote_host_light* light) { delete light; }
const char* mote_host_light_error(const mote_host_light* light) {
    return light ? light->error.text() : "the handle is null";
}
size_t mote_host_light_size(const mote_host_light* light) {
    return light && light->light ? light->light->size() : 0;
}

mote_status mote_host_light_trace(mote_host_light* light, const mote_host_options* scene,
                                  const mote_host_light_options* options) {
    if (!light) return MOTE_INVALID_ARGUMENT;
    return c::guarded(light->error, [&] {
        const session::HostLightSettings settings = settings_of(c::known_options(options));
        auto host =
            std::make_unique<session::HostScene>(data_of(c::known_options(&required(scene, "the scene"))));
        auto traced = std::make_unique<session::HostLight>(*host, settings);
        light->light = std::move(traced);  // before the scene that the old one refers to
        light->scene = std::move(host);
    });
}

mote_status mote_host_light_reflect(mote_host_light* light, const mote_receiver* receivers, size_t count,
                                    float* radiance) {
    if (!light) return MOTE_INVALID_ARGUMENT;
    return c::guarded(light->error, [&] {
        if (!light->light) throw c::InvalidArgument("mote_host_light_trace() comes first");
        std::vector<session::HostReceiver> places;
        for (std::size_t i = 0; i < count; ++i) {
            const mote_receiver& r = (&required(receivers, "the receivers"))[i];
            places.push_back({vec3(r.position), vec3(r.normal), r.material});
        }
        const std::vector<Rgb> found = light->light->reflected(places);
        for (std::size_t i = 0; i < count; ++i)
            for (int c = 0; c < 3; ++c)
                (&required(radiance, "the radiance"))[3 * i + std::size_t(c)] = found[i][c];
    });
}
