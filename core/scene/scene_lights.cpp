// Light sampling: for a receiver by the light hierarchy, for a particle by power.
//
// Lights at infinity and the emission of media have no place in the hierarchy, and are sampled half by power
// and half equally, so that no light is starved. All others share their part: most of it goes to the
// hierarchy, the rest stays with each as it is. For a hierarchy does not see what is in the way, nor how a
// surface reflects, and a bright light close by that does not count would leave hardly a chance to all
// others.
#include <algorithm>

#include "core/objects/error.h"
#include "core/scene/light_tree.h"
#include "core/scene/scene.h"

namespace mote::core {
namespace {

/// The hierarchy's part: at most 16 times as noisy as without it, wherever it is wrong.
constexpr float by_hierarchy = 15.0f / 16.0f;

/// The power of a light in one number, never negative.
float scalar_power(const Emitter& emitter, const std::string& file) {
    const Rgb power = emitter.power();
    if (!is_finite(power) || !(average(power) >= 0.0f))
        throw InputError("a light has a power that is negative or not finite", {file, 0});
    return average(power);
}

/// More bits than a float holds, so that a sample among many lights wears none of them out. They follow from
/// u.
double refined(float u) {
    std::uint64_t bits = std::uint64_t(double(u) * 0x1p32) * 0x9e3779b97f4a7c15ull;
    bits ^= bits >> 29, bits *= 0xbf58476d1ce4e5b9ull, bits ^= bits >> 32;
    return double(u) + double(bits >> 32) * 0x1p-32 * 0x1p-24;
}

}  // namespace

void Scene::build_light_tables() {
    std::vector<float> power;
    double total = 0.0;
    std::size_t lit = 0;
    for (const auto& emitter : parts_.emitters) {
        emitter_index_.emplace(emitter.get(), power.size());
        if (emitter->traits().kind == EmitterKind::environment) environment_ = emitter.get();
        power.push_back(scalar_power(*emitter, parts_.file));
        total += double(power.back());
        lit += power.back() > 0.0f;
    }
    if (lit == 0) std::fill(power.begin(), power.end(), 1.0f);  // all black: any choice is right
    std::vector<float> relative, mixed;
    std::vector<LightBounds> bounds;
    double in_tree = 0.0;
    tree_index_.assign(power.size(), no_tree);
    for (std::size_t i = 0; i < power.size(); ++i) {
        relative.push_back(lit == 0 ? power[i] : float(double(power[i]) / total));
        const float equal = power[i] > 0.0f ? 1.0f / float(std::max<std::size_t>(lit, 1)) : 0.0f;
        const Emitter& emitter = *parts_.emitters[i];
        float chance = lit == 0 ? 1.0f : 0.5f * relative.back() + 0.5f * equal;
        if (!emitter.traits().direct) chance = 0.0f;
        const auto place = lit > 0 && chance > 0.0f ? emitter.bounds() : std::nullopt;
        if (place && place->intensity > 0.0 && std::isfinite(place->intensity) && !place->box.empty()) {
            tree_index_[i] = std::uint32_t(bounds.size());
            bounds.push_back(*place), tree_lights_.push_back(std::uint32_t(i));
            in_tree += double(by_hierarchy * chance), chance *= 1.0f - by_hierarchy;
        }
        mixed.push_back(chance);
    }
    light_tree_ = std::make_unique<const LightTree>(bounds);
    mixed.push_back(float(in_tree));
    direct_lights_ = Distribution1D(mixed);
    const auto chosen = [](const auto& emitter) { return emitter->traits().direct; };
    if (std::count_if(parts_.emitters.begin(), parts_.emitters.end(), chosen) == 1 && !direct_lights_.empty())
        only_light_ = std::find_if(parts_.emitters.begin(), parts_.emitters.end(), chosen)->get();
    for (std::size_t i = 0; i < power.size(); ++i)
        if (tree_index_[i] == no_tree)
            parts_.emitters[i]->set_direct_probability(direct_lights_.probability(i));
    particle_lights_ = Distribution1D(relative);
}

LightChoice Scene::choose_light(const LightReceiver& receiver, float u) const {
    if (only_light_) return {only_light_, 1.0f};
    if (direct_lights_.empty()) return {nullptr, 0.0f};
    const auto sampled = direct_lights_.sample_discrete(u);
    std::size_t light = sampled.index;
    if (light == parts_.emitters.size()) {  // by the hierarchy
        const auto choice = light_tree_->sample(receiver, refined(sampled.remapped));
        light = tree_lights_[choice.light];
        return {parts_.emitters[light].get(),
                float(double(sampled.probability) * choice.probability) + direct_lights_.probability(light)};
    }
    return {parts_.emitters[light].get(), probability_of(light, receiver)};
}

float Scene::light_probability(const LightReceiver& receiver, const Emitter* emitter) const {
    if (only_light_) return emitter == only_light_ ? 1.0f : 0.0f;
    const auto it = emitter_index_.find(emitter);
    return it == emitter_index_.end() ? 0.0f : probability_of(it->second, receiver);
}

float Scene::probability_of(std::size_t light, const LightReceiver& receiver) const {
    float probability = direct_lights_.probability(light);
    if (const std::uint32_t in_tree = tree_index_[light]; in_tree != no_tree)
        probability += float(double(direct_lights_.probability(parts_.emitters.size())) *
                             light_tree_->probability(receiver, in_tree));
    return probability;
}

LightChoice Scene::choose_emitter_by_power(float u, float* remapped) const {
    if (particle_lights_.empty()) return {nullptr, 0.0f};
    const auto chosen = particle_lights_.sample_discrete(u);
    if (remapped) *remapped = chosen.remapped;
    return {parts_.emitters[chosen.index].get(), chosen.probability};
}

float Scene::probability_by_power(const Emitter* emitter) const {
    const auto it = emitter_index_.find(emitter);
    return it == emitter_index_.end() ? 0.0f : particle_lights_.probability(it->second);
}

}  // namespace mote::core
