// Sizes and alignments of what crosses the border between mote and its consumers: one line a type. Compiled
// twice, as mote is (-march, warnings, MOTE_LAYOUTS_INSIDE) and as a consumer's plain compiler does; both
// must print the same.
#include <mote/compensation/vpl_compensation.h>
#include <mote/core/film/film.h>
#include <mote/core/render/render_driver.h>
#include <mote/core/scene/callback_scene.h>
#include <mote/core/scene/scattering_vertex.h>
#include <mote/core/scene/scene.h>
#include <mote/gathering/ray_bundles/bundle_tracer.h>
#include <mote/lights/imperfect_shadow_maps/imperfect_shadow_maps.h>
#include <mote/lights/shadow_maps/shadow_map_gather.h>
#include <mote/lights/virtual_lights/vpl_gather.h>
#include <mote/screenspace/g_buffer/g_buffer.h>
#include <mote/screenspace/ssbc/ssbc.h>
#include <mote/version.h>

#include <cstdio>
#include <type_traits>

using namespace mote;

#if !defined(MOTE_LAYOUTS_INSIDE) && (defined(__AVX__) || !defined(__SSE2__))
#error "the consumer is meant to be compiled for any x86-64"
#endif

template <typename T>
void print(const char* name) {
    std::printf("%s size %zu alignment %zu trivial %d\n", name, sizeof(T), alignof(T),
                int(std::is_trivially_default_constructible_v<T>));
}
#define PRINT(type) print<type>(#type)

int main() {
    std::printf("mote %s %d\n", MOTE_VERSION_STRING, MOTE_VERSION_NUMBER);
    PRINT(core::Vec2), PRINT(core::Vec3), PRINT(core::Vec3d), PRINT(core::Ray), PRINT(core::Frame);
    PRINT(core::Transform), PRINT(core::Bounds3), PRINT(core::ShadowPacket), PRINT(core::SurfaceHit);
    PRINT(core::MediumState), PRINT(core::PathWeights), PRINT(core::WalkContext), PRINT(core::WalkEvent);
    PRINT(core::ScatteringVertex), PRINT(core::EmissionSample), PRINT(core::DirectSample),
        PRINT(core::BsdfPoint);
    PRINT(core::SceneCallbacks), PRINT(core::CallbackScene), PRINT(core::Scene), PRINT(core::Scene::Parts);
    PRINT(core::Film), PRINT(core::RenderRequest), PRINT(core::RenderResult);
    PRINT(lights::VirtualPointLight), PRINT(lights::VplSet), PRINT(lights::ReceiverLanes);
    PRINT(lights::ReceiverTile), PRINT(lights::LaneLight), PRINT(lights::GatherScratch),
        PRINT(lights::TileSum);
    PRINT(lights::ShadowLookup), PRINT(lights::ShadowMapView), PRINT(lights::VolumetricShadowMap);
    PRINT(lights::ImperfectShadowMaps), PRINT(lights::ShadowMapGather);
    PRINT(compensation::VplCompensationScratch), PRINT(compensation::ResidualPath);
    PRINT(gathering::BundleTracer), PRINT(gathering::BundleHit);
    PRINT(screenspace::GBuffer), PRINT(screenspace::SsbcSettings), PRINT(screenspace::SsbcSurfaces);
}
