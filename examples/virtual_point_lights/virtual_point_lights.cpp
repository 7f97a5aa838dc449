// Virtual point lights in a triangle soup of one's own, traced by an Embree scene of one's own: a closed room
// with grey walls and a lamp. What its walls receive in all is known: power / (area (1 - reflectance)),
// bounces included.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <mote/core/materials/bsdfs.h>
#include <mote/core/materials/textures.h>
#include <mote/core/scene/callback_scene.h>
#include <mote/lights/emitters/emitters.h>
#include <mote/lights/virtual_lights/particle_tracer.h>
#include <mote/lights/virtual_lights/vpl_gather.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace mote;
using core::Ray, core::Rgb, core::SurfaceHit, core::Vec3;

RTCScene unit_cube(RTCDevice device) {
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* v = static_cast<float*>(
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 8));
    auto* t = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, 12));
    for (unsigned i = 0; i < 8; ++i)
        v[3 * i] = float(i & 1), v[3 * i + 1] = float(i >> 1 & 1), v[3 * i + 2] = float(i >> 2);
    const unsigned corners[] = {0, 1, 3, 0, 3, 2, 4, 7, 5, 4, 6, 7, 0, 5, 1, 0, 4, 5,
                                2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 7, 3, 1, 5, 7};
    std::copy(std::begin(corners), std::end(corners), t);
    RTCScene scene = rtcNewScene(device);
    rtcCommitGeometry(mesh), rtcAttachGeometry(scene, mesh), rtcCommitScene(scene), rtcReleaseGeometry(mesh);
    return scene;
}

std::optional<SurfaceHit> trace(RTCScene soup, const core::ForeignSurface& wall, const Ray& ray) {
    RTCRayHit r{};
    r.ray.org_x = ray.origin.x, r.ray.org_y = ray.origin.y, r.ray.org_z = ray.origin.z;
    r.ray.dir_x = ray.direction.x, r.ray.dir_y = ray.direction.y, r.ray.dir_z = ray.direction.z;
    r.ray.tnear = ray.t_min, r.ray.tfar = ray.t_max, r.ray.mask = ~0u;
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(soup, &r);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context), rtcIntersect1(soup, &context, &r);
#endif
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    const Vec3 normal = glm::normalize(Vec3(r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z));
    return wall.hit(ray, r.ray.tfar, glm::dot(normal, ray.direction) < 0.0f ? normal : -normal, 1e-6f);
}

/// A ray to a place on one of the six walls, evenly by area.
Ray to_wall(core::Rng& rng) {
    const int axis = std::min(2, int(3.0f * rng.next_float()));
    Ray ray{{rng.next_float(), rng.next_float(), rng.next_float()}, Vec3(0.0f)};
    ray.origin[axis] = 0.5f, ray.direction[axis] = rng.next_float() < 0.5f ? -1.0f : 1.0f;
    return ray;
}

int main() {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene soup = unit_cube(device);
    const float reflectance = 0.5f, intensity = 2.0f;  // [W/sr]
    const core::ForeignSurface wall(core::make_diffuse(core::make_constant_texture(Rgb(reflectance))));
    const core::CallbackScene scene({.first_hit = [&](const Ray& ray) { return trace(soup, wall, ray); },
                                     .emitters = {lights::make_point_light({0.4, 0.5, 0.6}, Rgb(intensity))},
                                     .bounds = {Vec3(0.0f), Vec3(1.0f)}});

    const lights::VplSet vpls =
        lights::trace_light_paths(scene, {.paths = 1024}, 1, 0, core::SamplerKind::sobol);
    lights::GatherScratch scratch;
    core::RayCounters rays;
    core::TrackingCounters tracking;
    core::Rng rng(7);
    double sum = 0.0;
    const int tiles = 200;
    for (int i = 0; i < tiles; ++i) {  // sixteen places at once
        lights::ReceiverTile tile;
        for (int lane = 0; lane < lights::ReceiverLanes::width; ++lane) {
            const Ray ray = to_wall(rng);
            core::WalkEvent arrived;
            arrived.kind = core::WalkEvent::Kind::surface, arrived.hit = *scene.first_hit(ray);
            tile.set(lane, core::make_vertex(arrived, ray), Rgb(1.0f), {}, rng, 1000);
        }
        for (const Rgb& radiance : lights::gather({scene, scratch, rays, tracking}, vpls, lights::VplRange{},
                                                  lights::BoundedGeometry{core::infinity}, tile))
            sum += double(radiance.x * core::pi / reflectance) / (16.0 * tiles);  // irradiance by bounces
    }
    const double power = 4.0 * 3.14159265 * intensity, area = 6.0;
    const double expected = power / (area * (1.0 - reflectance)) - power / area;
    std::printf("%zu lights, %llu shadow rays: walls receive %.4f W/m^2 by bounces, %.4f by energy\n",
                vpls.lights.size(), static_cast<unsigned long long>(rays.occlusion), sum, expected);
    rtcReleaseScene(soup), rtcReleaseDevice(device);
    return std::fabs(sum / expected - 1.0) < 0.02 ? 0 : 1;
}
