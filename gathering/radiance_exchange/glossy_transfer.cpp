#include "gathering/radiance_exchange/glossy_transfer.h"

#include <tbb/parallel_for.h>

#include "core/scene/scattering_vertex.h"

namespace mote::gathering {

using namespace core;

void GlossyTransfer::send(ExchangeBatch::Sent& sent, const ExchangeBatch& last,
                          const TexelDirectLight& sampled, const BatchDirections& directions,
                          std::uint32_t b) const {
    const auto& glossy = scene_.materials.glossy;
    if (!on_ || glossy.empty()) return;
    const std::uint32_t m = last.size();
    sent.glossy.assign(std::size_t(m) * glossy.size(), Rgb4{});
    tbb::parallel_for(std::size_t(0), glossy.size(), [&](std::size_t g) {
        const std::uint32_t texel = glossy[g];
        const AtlasTexel& t = scene_.atlas.texels()[texel];
        ScatteringVertex vertex;
        vertex.hit = scene_.atlas.place(t);
        vertex.position = vertex.hit.position, vertex.bsdf = vertex.hit.shape->bsdf.get();
        const Vec3 outside = outward(vertex.hit, t.side);
        for (std::uint32_t next = 0; next < m; ++next) {
            const Vec3 d = directions.at(b * m + next).direction;
            vertex.wo = glm::dot(outside, d) < 0.0f ? -d : d;
            Rgb sum(0.0f);
            // f(w, w') times the irradiance from w, whose cosine is in the number of rays.
            for (std::uint32_t i = 0; b > 0 && i < m; ++i)
                if (const Rgb e = last.irradiance(i, texel); !is_black(e))
                    sum +=
                        vertex.eval(last.direction_above(i, texel), TransportMode::radiance) * e / float(m);
            for (int k = 0; k < sampled.samples; ++k) {
                const TexelLightSample& s = sampled.glossy[g * std::size_t(sampled.samples) + std::size_t(k)];
                if (!is_black(s.irradiance)) sum += vertex.eval(s.wi, TransportMode::radiance) * s.irradiance;
            }
            sent.glossy[next * glossy.size() + g] = rgb4(sum);
        }
        sent.reflected[texel] = rgb4(Rgb(0.0f), float(g + 1));
    });
}

}  // namespace mote::gathering
