#include "gathering/radiance_exchange/radiance_exchange.h"

#include "gathering/radiance_exchange/glossy_transfer.h"
#include "gathering/radiance_exchange/power_balance.h"

namespace mote::gathering {

using namespace core;

namespace {

using Irradiance = std::vector<Rgb>;

void add(Irradiance& sum, const Irradiance& x, float weight) {
    for (std::size_t t = 0; t < x.size(); ++t) sum[t] += weight * x[t];
}

class Exchange {
  public:
    Exchange(const ExchangeScene& scene, const ExchangeSettings& settings, const TexelDirectLight& direct,
             std::uint64_t key, CancelToken cancelled)
        : scene_(scene),
          settings_(settings),
          sampled_(direct),
          directions_(key, settings.batch),
          cancelled_(cancelled),
          n_(scene.atlas.size()),
          batch_(scene, 1.0f / (scene.atlas.texels_per_metre() * std::sqrt(settings.rays_per_texel)),
                 settings.batch, settings.lights) {
        sent_.reflected.resize(n_);
        light_.indirect.resize(n_);
        if (settings.lights) light_.direct.resize(n_);
    }
    ArrivingLight interleaved();
    ArrivingLight one_bounce();
    const ExchangeBatch& batch() const { return batch_; }
    std::uint64_t directions() const { return std::uint64_t(batches_) * batch_.size(); }

  private:
    TexelIrradiance run() {
        batch_.run(directions_, batches_ * batch_.size(), sent_, cancelled_);
        ++batches_;
        return batch_.mean();
    }
    /// Lambertian texels send the light of `arriving` that they reflect.
    void reflect(const Irradiance& arriving) {
        for (std::size_t t = 0; t < n_; ++t)
            sent_.reflected[t] = rgb4(scene_.materials.of[t].reflectance * inv_pi * arriving[t]);
    }
    /// Direct irradiance: that of TexelDirectLight plus `fraction` of the sum over batches.
    Irradiance direct(float fraction) const {
        Irradiance sum = sampled_.irradiance.empty() ? Irradiance(n_) : sampled_.irradiance;
        if (settings_.lights) add(sum, light_.direct, fraction);
        return sum;
    }

    ExchangeScene scene_;
    ExchangeSettings settings_;
    const TexelDirectLight& sampled_;
    BatchDirections directions_;
    CancelToken cancelled_;
    std::size_t n_;
    ExchangeBatch batch_;
    ExchangeBatch::Sent sent_;
    ArrivingLight light_;
    std::uint32_t batches_ = 0;
};

ArrivingLight Exchange::interleaved() {
    const std::uint32_t count = settings_.directions / settings_.batch;
    const std::uint32_t warm_up = std::min(settings_.warm_up, count - 1);
    GlossyTransfer glossy(scene_, settings_.glossy);
    Irradiance indirect(n_);
    for (std::uint32_t b = 0; b < count; ++b) {
        // L_{b-1}: what lights sent, the mean so far, and what the last batch received of the rest
        Irradiance arriving = direct(b > 0 ? 1.0f / float(b) : 0.0f);
        const PowerBalance balance(scene_, arriving, indirect);
        add(arriving, indirect, 1.0f);
        reflect(arriving);
        glossy.send(sent_, batch_, sampled_, directions_, b);
        const TexelIrradiance received = run();
        if (settings_.lights) add(light_.direct, received.emitted, 1.0f);
        indirect = received.reflected;
        if (b < warm_up)
            balance.scale(indirect);
        else
            add(light_.indirect, indirect, 1.0f / float(count - warm_up));
    }
    for (Rgb& e : light_.direct) e /= float(count);
    return std::move(light_);
}

ArrivingLight Exchange::one_bounce() {
    const std::uint32_t stages = settings_.bounces + (settings_.lights ? 0 : -1);
    const std::uint32_t count = std::max(1u, settings_.directions / settings_.batch / std::max(1u, stages));
    Irradiance arriving(n_);
    const auto stage = [&](bool emitted) {
        Irradiance sum(n_);
        for (std::uint32_t b = 0; b < count; ++b) {
            const TexelIrradiance received = run();
            add(sum, emitted ? received.emitted : received.reflected, 1.0f / float(count));
        }
        return sum;
    };
    if (settings_.lights) light_.direct = stage(true);
    arriving = direct(1.0f);
    for (std::uint32_t bounce = 1; bounce < settings_.bounces; ++bounce) {
        reflect(arriving);
        arriving = stage(false);
        add(light_.indirect, arriving, 1.0f);
    }
    return std::move(light_);
}

}  // namespace

ArrivingLight exchange_light(const ExchangeScene& scene, const ExchangeSettings& settings,
                             const TexelDirectLight& direct, std::uint64_t key, CancelToken cancelled,
                             ExchangeStatistics& statistics) {
    if (scene.atlas.size() == 0) return {};
    Exchange exchange(scene, settings, direct, key, cancelled);
    ArrivingLight light =
        settings.transfer == LightTransfer::interleaved ? exchange.interleaved() : exchange.one_bounce();
    statistics.directions += exchange.directions();
    statistics.hits += exchange.batch().hits();
    statistics.bytes = exchange.batch().memory_bytes();
    return light;
}

std::size_t exchange_bytes(std::size_t texels, const ExchangeSettings& settings) {
    return texels * sizeof(Rgb4) * (std::size_t(settings.batch) * (settings.lights ? 2 : 1) + 2);
}

}  // namespace mote::gathering
