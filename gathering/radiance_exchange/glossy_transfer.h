// Glossy texels: what the next batch of directions has them send (Hermes 2010, Sec. 5.4).
#pragma once

#include "gathering/radiance_exchange/exchange_batch.h"
#include "gathering/radiance_exchange/texel_direct_light.h"

namespace mote::gathering {

class GlossyTransfer {
  public:
    /// `on` = false: glossy texels send nothing.
    GlossyTransfer(const ExchangeScene& scene, bool on) : scene_(scene), on_(on) {}

    /// Before batch b (from 0): fills sent.glossy, and marks glossy texels in sent.reflected, from what the
    /// last batch received and from sampled direct light.
    void send(ExchangeBatch::Sent& sent, const ExchangeBatch& last, const TexelDirectLight& sampled,
              const BatchDirections& directions, std::uint32_t b) const;

  private:
    ExchangeScene scene_;
    bool on_;
};

}  // namespace mote::gathering
