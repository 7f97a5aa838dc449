#include "lights/emitters/other_lights.h"

#include <algorithm>
#include <bit>

#include "core/math/random.h"

namespace mote::lights {

using namespace core;

namespace {
/// Where the others have a chance of one in so many, nothing is sampled any more: it would take too long.
constexpr float min_chance = 1.0f / 4096.0f;
}  // namespace

OtherLights::OtherLights(const LitScene& scene, std::vector<const Emitter*> left_out)
    : scene_(scene), left_out_(std::move(left_out)) {
    any_ = std::any_of(scene.emitters().begin(), scene.emitters().end(),
                       [&](const auto& emitter) { return !is_left_out(emitter.get()); });
}

bool OtherLights::is_left_out(const Emitter* emitter) const {
    return std::find(left_out_.begin(), left_out_.end(), emitter) != left_out_.end();
}

float OtherLights::probability_of_others(const LightReceiver& receiver) const {
    float of_left_out = 0.0f;
    for (const Emitter* emitter : left_out_) of_left_out += scene_.light_probability(receiver, emitter);
    const float others = 1.0f - of_left_out;
    return others > min_chance ? others : 0.0f;
}

/// Samples until it is one of the others, with numbers that follow from u.
LightChoice OtherLights::choose_light(const LightReceiver& receiver, float u) const {
    const float others = any_ ? probability_of_others(receiver) : 0.0f;
    if (!(others > 0.0f)) return {nullptr, 0.0f};
    Rng rng(std::bit_cast<std::uint32_t>(u));
    for (;; u = rng.next_float()) {
        const LightChoice choice = scene_.choose_light(receiver, u);
        if (!choice.emitter) return choice;
        if (!is_left_out(choice.emitter)) return {choice.emitter, choice.probability / others};
    }
}

float OtherLights::light_probability(const LightReceiver& receiver, const Emitter* emitter) const {
    if (is_left_out(emitter)) return 0.0f;
    const float others = probability_of_others(receiver);
    return others > 0.0f ? scene_.light_probability(receiver, emitter) / others : 0.0f;
}

}  // namespace mote::lights
