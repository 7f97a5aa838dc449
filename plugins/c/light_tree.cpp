// A hierarchy over a host's lights.
#include <cmath>
#include <limits>

#include "core/scene/light_tree.h"
#include "plugins/c/handles.h"

using namespace mote;
using c::required, c::vec3;
using core::Vec3;

struct mote_light_tree {
    core::LightTree tree;
};

namespace {

bool is_unit(const Vec3& n) { return std::fabs(glm::dot(n, n) - 1.0f) < 1e-3f; }

core::LightBounds bounds_of(const mote_light& light) {
    core::LightBounds bounds;
    bounds.box = {vec3(light.lower), vec3(light.upper)};
    bool can_be = light.intensity > 0.0 && std::isfinite(light.intensity);
    for (int i = 0; i < 3; ++i)
        can_be = can_be && std::isfinite(light.lower[i]) && std::isfinite(light.upper[i]) &&
                 light.lower[i] <= light.upper[i];
    const Vec3 normal = vec3(light.normal);
    if (normal != Vec3(0.0f)) {
        can_be = can_be && is_unit(normal);
        bounds.normals = core::DirectionCone::of(normal);
    }
    if (!can_be)
        throw c::InvalidArgument("a light has a box, an intensity above 0, and a unit normal or none");
    bounds.intensity = light.intensity;
    return bounds;
}

core::LightReceiver receiver_of(const float* position, const float* normal) {
    core::LightReceiver receiver{vec3(&required(position, "the position")), Vec3(0.0f)};
    if (normal) receiver.normal = vec3(normal);
    if (!std::isfinite(glm::dot(receiver.position, receiver.position)) ||
        (receiver.normal != Vec3(0.0f) && !is_unit(receiver.normal)))
        throw c::InvalidArgument("a receiver has a finite position, and a unit normal or none");
    return receiver;
}

}  // namespace

mote_light_tree* mote_light_tree_new(const mote_light* lights, size_t count, mote_status* status) {
    mote_light_tree* made = nullptr;
    c::LastError unheard;
    const mote_status result = c::guarded(unheard, [&] {
        if (count < 1 || count > std::size_t(1) << 28)
            throw c::InvalidArgument("a hierarchy has from 1 to 2^28 lights");
        std::vector<core::LightBounds> bounds;
        bounds.reserve(count);
        for (std::size_t i = 0; i < count; ++i)
            bounds.push_back(bounds_of((&required(lights, "the lights"))[i]));
        made = new mote_light_tree{core::LightTree(bounds)};
    });
    if (status) *status = result;
    return made;
}
void mote_light_tree_free(mote_light_tree* tree) { delete tree; }

mote_status mote_light_tree_sample(const mote_light_tree* tree, const float position[3],
                                   const float normal[3], double u, size_t* light, double* probability) {
    c::LastError unheard;
    return c::guarded(unheard, [&] {
        if (!(u >= 0.0 && u < 1.0)) throw c::InvalidArgument("u is in [0, 1)");
        const auto choice = required(tree, "the hierarchy").tree.sample(receiver_of(position, normal), u);
        required(light, "the light") = choice.light;
        if (probability) *probability = choice.probability;
    });
}

double mote_light_tree_probability(const mote_light_tree* tree, const float position[3],
                                   const float normal[3], size_t light) {
    double probability = std::numeric_limits<double>::quiet_NaN();
    c::LastError unheard;
    c::guarded(unheard, [&] {
        const core::LightTree& lights = required(tree, "the hierarchy").tree;
        if (light >= lights.size()) throw c::InvalidArgument("there is no such light");
        probability = lights.probability(receiver_of(position, normal), std::uint32_t(light));
    });
    return probability;
}
