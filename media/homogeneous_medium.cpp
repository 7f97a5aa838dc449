// <medium type="homogeneous">: analytic transmittance, distances and emission.
//
// Distances follow the hero channel h: p(t) = sigma_t,h exp(-sigma_t,h t); the ratios of the other channels'
// densities to it go into PathWeights (Wilkie et al. 2014).
#include "media/homogeneous_medium.h"

#include <fmt/format.h>

#include <array>

#include "core/parameters/add_type.h"
#include "core/scene/scattering_points.h"
#include "media/medium_emitter.h"
#include "media/phase_functions.h"
#include "media/tracking_random.h"

namespace mote::media {

using core::Ray, core::Rgb, core::Rng;

namespace {

bool is_grey(const Rgb& c) { return c.x == c.y && c.y == c.z; }

double length_of(const Ray& ray) { return double(ray.t_max) - double(ray.t_min); }

Rgb transmittance_over(const Rgb& sigma_t, double length) {
    if (is_grey(sigma_t)) return Rgb(float(std::exp(-optical_depth(sigma_t.x, length))));
    Rgb t;
    for (int c = 0; c < 3; ++c) t[c] = float(std::exp(-optical_depth(sigma_t[c], length)));
    return t;
}

/// The integral of exp(-sigma_t t) * emission over [0, length]: emission (1 - exp(-tau)) / sigma_t.
Rgb emission_along(const Rgb& sigma_t, const Rgb& emission, double length) {
    Rgb sum(0.0f);
    for (int c = 0; c < 3; ++c)
        if (emission[c] > 0.0f)  // implies sigma_t > 0
            sum[c] = float(double(emission[c]) * -std::expm1(-double(sigma_t[c]) * length) / sigma_t[c]);
    return sum;
}

}  // namespace

HomogeneousMedium::HomogeneousMedium(const Rgb& sigma_t, const Rgb& sigma_s, const Rgb& emitted_radiance,
                                     std::shared_ptr<core::PhaseFunction> phase)
    : sigma_t_(sigma_t), sigma_s_(sigma_s), phase_(std::move(phase)) {
    for (int c = 0; c < 3; ++c) {
        if (!(sigma_t[c] >= 0.0f && sigma_s[c] >= 0.0f && emitted_radiance[c] >= 0.0f) ||
            !std::isfinite(sigma_t[c]) || !std::isfinite(emitted_radiance[c]))
            throw core::InputError("a medium's coefficients must be finite and not negative");
        if (sigma_s[c] > sigma_t[c] * 1.000001f)
            throw core::InputError("a medium cannot scatter more than its extinction (albedo above 1)");
        sigma_s_[c] = std::fmin(sigma_s[c], sigma_t[c]);
    }
    emission_ = (sigma_t_ - sigma_s_) * emitted_radiance;
    absorbs_alone_ = core::is_black(sigma_s_);
}

core::Bounds3 HomogeneousMedium::bounds() const {
    return {core::Vec3(-core::infinity), core::Vec3(core::infinity)};
}

std::shared_ptr<core::Emitter> HomogeneousMedium::make_emitter(const core::Bounds3& box) {
    if (core::is_black(emission_) || box.empty()) return nullptr;
    return std::make_shared<MediumEmitter>(*this, box, false);
}

core::MediumTraits HomogeneousMedium::traits() const {
    core::MediumTraits t;
    t.homogeneous = true;
    t.emissive = !core::is_black(emission_);
    t.isotropic = phase_->isotropic();
    t.chromatic = sigma_t_.x != sigma_t_.y || sigma_t_.y != sigma_t_.z;
    t.scattering = !core::is_black(sigma_s_);
    t.empty = core::is_black(sigma_t_);
    t.description = t.chromatic ? fmt::format("homogeneous, extinction {:.3g} {:.3g} {:.3g} 1/m", sigma_t_.x,
                                              sigma_t_.y, sigma_t_.z)
                                : fmt::format("homogeneous, extinction {:.3g} 1/m", sigma_t_.x);
    return t;
}

/// Multiplies by what the channels have over the hero, with whose density a distance was sampled.
void HomogeneousMedium::update_channel_weights(core::PathWeights& weights, double travelled,
                                               bool collides) const {
    const double sigma_h = sigma_t_[weights.hero];
    for (int c = 0; c < 3; ++c) {
        // exp of the difference, so that neither transmittance underflows alone
        const double ratio =
            std::exp(optical_depth(sigma_h, travelled) - optical_depth(sigma_t_[c], travelled));
        weights.throughput[c] *= float(collides ? ratio * sigma_s_[c] / sigma_h : ratio);
        weights.unidirectional[c] *= float(collides ? ratio * sigma_t_[c] / sigma_h : ratio);
    }
}

std::optional<float> HomogeneousMedium::sample_collision(const Ray& ray, core::PathWeights& weights,
                                                         Rgb& emitted, Rng& rng,
                                                         core::TrackingCounters& counters) const {
    const double length = length_of(ray);
    if (!core::is_black(emission_))
        emitted += weights.throughput * emission_along(sigma_t_, emission_, length) /
                   core::average(weights.unidirectional);
    if (absorbs_alone_) {
        weights.throughput *= transmittance_over(sigma_t_, length);
        return std::nullopt;
    }

    const double sigma_h = sigma_t_[weights.hero];
    const double t = sigma_h > 0.0 ? sample_optical_depth(rng) / sigma_h : double(core::infinity);
    const bool collides = t < length;
    if (!is_grey(sigma_t_))
        update_channel_weights(weights, collides ? t : length, collides);
    else if (collides)
        weights.throughput *= sigma_s_ / sigma_t_;
    if (!collides) {
        if (!core::is_black(weights.light)) weights.light *= float(std::exp(optical_depth(sigma_h, length)));
        return std::nullopt;
    }
    ++counters.collisions;
    return std::fmin(float(ray.t_min + t), std::fmin(ray.t_max, std::numeric_limits<float>::max()));
}

/// Distances to scatterings before the end of the ray, of the channels in turn: channel h has the density
/// sigma_h exp(-sigma_h t) / (1 - T_h), and points count by the mean over channels (balance heuristic). Grey
/// media need no other weights than that of 1 - T.
void HomogeneousMedium::scatter_along(const Ray& ray, core::PathWeights& weights, Rgb& emitted,
                                      core::ScatteringPoints& points, Rng& rng,
                                      core::TrackingCounters& counters) const {
    const double length = length_of(ray);
    const Rgb start = weights.throughput / core::average(weights.unidirectional);
    if (!core::is_black(emission_)) emitted += start * emission_along(sigma_t_, emission_, length);
    std::array<int, 3> channels;
    std::array<double, 3> collides;  // 1 - T_h
    int count = 0;
    for (int c = 0; c < 3; ++c)
        if (sigma_t_[c] > 0.0f)
            channels[std::size_t(count)] = c,
            collides[std::size_t(count++)] = -std::expm1(-optical_depth(sigma_t_[c], length));
    const int samples = absorbs_alone_ || !(length > 0.0) ? 0 : points.count();
    const int first = samples > 0 ? std::min(int(rng.next_float() * float(count)), count - 1) : 0;
    for (int i = 0; i < samples; ++i) {
        const auto h = std::size_t((first + i) % count);
        const double u = (double(i) + double(rng.next_float())) / double(samples);
        const double t = -std::log1p(-u * collides[h]) / sigma_t_[channels[h]];
        // Everything over the transmittance of channel h, which may be as small as it likes.
        const double of_h = optical_depth(sigma_t_[channels[h]], t);
        double density = 0.0;
        for (std::size_t j = 0; j < std::size_t(count); ++j) {
            const double sigma = sigma_t_[channels[j]];
            density += sigma * std::exp(of_h - optical_depth(sigma, t)) / collides[j] / double(count);
        }
        Rgb weight;
        for (int c = 0; c < 3; ++c)
            weight[c] = float(std::exp(of_h - optical_depth(sigma_t_[c], t)) * sigma_s_[c] /
                              (density * double(samples)));
        const double far = std::min(double(ray.t_min) + t, double(ray.t_max));
        points.add(ray.at(std::fmin(float(far), std::numeric_limits<float>::max())), start * weight);
    }
    counters.collisions += std::uint64_t(samples);
    weights.throughput *= transmittance_over(sigma_t_, length);
}

void HomogeneousMedium::connect(const Ray& ray, core::PathWeights& weights, Rng&,
                                core::TrackingCounters&) const {
    const Rgb t = transmittance_over(sigma_t_, length_of(ray));
    weights.throughput *= t;
    if (!absorbs_alone_) weights.unidirectional *= t;
}

Rgb HomogeneousMedium::transmittance(const Ray& ray, Rng&, core::TrackingCounters&) const {
    return transmittance_over(sigma_t_, length_of(ray));
}

core::Vec3d HomogeneousMedium::optical_depth_along(const Ray& ray, float, core::TrackingCounters&) const {
    core::Vec3d depth;
    for (int c = 0; c < 3; ++c) depth[c] = optical_depth(sigma_t_[c], length_of(ray));
    return depth;
}

namespace {

struct HomogeneousSettings {
    Rgb sigma_t{1.0f}, albedo{0.75f};
    std::optional<Rgb> sigma_s, sigma_a;
    float scale = 1.0f;
    Rgb radiance{0.0f};
    float radiance_scale = 1.0f;
    std::shared_ptr<core::PhaseFunction> phase = std::make_shared<IsotropicPhase>();
};

const core::ParameterList<HomogeneousSettings>& homogeneous_rows() {
    using namespace core;
    using S = HomogeneousSettings;
    static const ParameterList<S> list{
        row("sigma_t", &S::sigma_t, at_least(0, "1/m"), "Extinction, times `scale`."),
        row("albedo", &S::albedo, between(0, 1), "Single-scattering albedo."),
        row("sigma_s", &S::sigma_s, at_least(0, "1/m"),
            "Scattering, times `scale`; with sigma_a instead of sigma_t and albedo.")
            .when_absent("none"),
        row("sigma_a", &S::sigma_a, at_least(0, "1/m"),
            "Absorption, times `scale`; with sigma_s instead of sigma_t and albedo.")
            .when_absent("none"),
        row("scale", &S::scale, at_least(0), "Multiplies the coefficients."),
        row("Le", &S::radiance, at_least(0, "W/(m^2 sr)"),
            "Emitted radiance; the source term is sigma_a Le, as in pbrt."),
        row("Lescale", &S::radiance_scale, at_least(0), "Multiplies Le."),
        nested("phase", &S::phase, Category::phase, "isotropic", "The phase function.")};
    return list;
}

std::shared_ptr<HomogeneousMedium> make_homogeneous(const HomogeneousSettings& s, const core::Properties& p) {
    const bool by_parts = s.sigma_s || s.sigma_a;
    if (by_parts && (p.has("albedo") || p.has("sigma_t")))
        throw core::InputError("give either 'sigma_t' and 'albedo', or 'sigma_s' and 'sigma_a'", p.where);
    Rgb sigma_t = s.sigma_t, sigma_s = s.sigma_t * s.albedo;
    if (by_parts) {
        sigma_s = s.sigma_s.value_or(Rgb(0.0f));
        sigma_t = sigma_s + s.sigma_a.value_or(Rgb(0.0f));
    }
    return std::make_shared<HomogeneousMedium>(s.scale * sigma_t, s.scale * sigma_s,
                                               s.radiance * s.radiance_scale, s.phase);
}

}  // namespace

void register_homogeneous_medium(core::Registry& registry) {
    core::add_type(
        registry, core::Category::medium, "homogeneous",
        "The same coefficients everywhere; transmittance and distances are analytic.", homogeneous_rows(),
        R"(<medium type="homogeneous"><rgb name="sigma_t" value="1 2 3"/><rgb name="albedo" value="0.9"/></medium>)",
        make_homogeneous);
}

}  // namespace mote::media
