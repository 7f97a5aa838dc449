#include "gathering/photon_maps/photon_tracer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <string>

namespace mote::gathering {

using namespace core;

namespace {

constexpr std::uint32_t chunk_size = 64;              ///< paths of one task
constexpr std::uint32_t batch_size = 16384;           ///< paths between two checks of the memory
constexpr std::uint32_t photon_stream = 0x50484f54u;  // keeps light paths apart from pixels of the same index

std::uint16_t medium_index(const LitScene& scene, const PhaseFunction* phase) {
    const auto media = scene.media();
    for (std::size_t i = 0; i < media.size(); ++i)
        if (&media[i]->phase() == phase) return std::uint16_t(i);
    return 0;  // not reached: a vertex in a medium has the phase function of one of the scene's media
}

/// True if photon number `depth` of this path is kept when 2^-halvings of all are. A photon kept at one n was
/// kept at all smaller ones.
bool is_kept(std::uint64_t path_key, std::uint32_t depth, int halvings) {
    return halvings == 0 || hash_keys(path_key, depth) >> (64 - halvings) == 0;
}

/// A photon with the data that thinning needs.
struct Candidate {
    Photon photon;
    std::uint64_t path_key;
    std::uint32_t depth;
    bool surface;
};

struct Chunk {
    std::vector<Candidate> kept;
    std::uint64_t met = 0;
    RayCounters rays;
    TrackingCounters tracking;
};

class ChunkTracer {
  public:
    ChunkTracer(const LitScene& scene, const PhotonSettings& settings, int halvings, CancelToken cancelled)
        : scene_(scene), settings_(settings), halvings_(halvings), cancelled_(cancelled) {}

    template <bool Media>
    Chunk trace(std::uint32_t begin, std::uint32_t end, std::uint64_t seed, std::uint32_t pass,
                SamplerKind kind) const {
        Chunk chunk;
        for (std::uint32_t path = begin; path < end; ++path) {
            // The paths of one pass form one low-discrepancy set; every pass has a scramble of its own.
            Sampler sampler(kind, seed, path, pass, photon_stream);
            WalkContext context;
            context.cancelled = cancelled_;
            const std::uint64_t key = hash_keys(seed, pass, path, photon_stream);
            context.rng = Rng(key);
            lights::follow_light_path<Media>(scene_, settings_.paths, sampler, context,
                                             [&](const ScatteringVertex& v, const Rgb& alpha, int depth,
                                                 const MediumState&) { leave(chunk, v, alpha, depth, key); });
            chunk.rays.add(context.rays);
            chunk.tracking.add(context.tracking);
        }
        return chunk;
    }

  private:
    void leave(Chunk& chunk, const ScatteringVertex& v, const Rgb& alpha, int depth,
               std::uint64_t key) const {
        const bool surface = v.on_surface();
        const int first = surface ? settings_.first_on_surface : settings_.first_in_medium;
        if (depth < first || is_black(alpha) || !v.connectable()) return;
        ++chunk.met;
        if (!is_kept(key, std::uint32_t(depth), halvings_)) return;
        // A mask stops photons and eye paths each by chance, and is there once: one chance is taken back.
        Photon photon{v.position, encode_direction(v.wo), alpha / v.stop_chance, 0,
                      std::uint16_t(std::min(depth, 65535))};
        photon.normal_or_medium =
            surface ? encode_normal(v.hit.geometric_normal) : medium_index(scene_, v.phase);
        chunk.kept.push_back({photon, key, std::uint32_t(depth), surface});
    }

    const LitScene& scene_;
    const PhotonSettings& settings_;
    int halvings_;
    CancelToken cancelled_;
};

void thin(std::vector<Candidate>& photons, int halvings) {
    std::erase_if(photons, [&](const Candidate& c) { return !is_kept(c.path_key, c.depth, halvings); });
}

PhotonSet split(std::vector<Candidate>&& candidates, int halvings) {
    PhotonSet set;
    const auto surfaces =
        std::count_if(candidates.begin(), candidates.end(), [](auto& c) { return c.surface; });
    set.surface.reserve(std::size_t(surfaces));
    set.volume.reserve(candidates.size() - std::size_t(surfaces));
    const float fraction = std::ldexp(1.0f, halvings);
    for (Candidate& c : candidates) {
        c.photon.power *= fraction;
        (c.surface ? set.surface : set.volume).push_back(c.photon);
    }
    return set;
}

}  // namespace

PhotonSet trace_photons(const LitScene& scene, const PhotonSettings& settings, std::uint64_t seed,
                        std::uint32_t pass, SamplerKind sampler, CancelToken cancelled) {
    std::vector<Candidate> kept;
    std::uint64_t met = 0;
    int halvings = 0;
    RayCounters rays;
    TrackingCounters tracking;
    const std::uint32_t paths = settings.paths.paths;
    for (std::uint32_t first = 0; first < paths; first += std::min(batch_size, paths - first)) {
        const std::uint32_t last = first + std::min(batch_size, paths - first);
        const ChunkTracer tracer(scene, settings, halvings, cancelled);
        std::vector<Chunk> chunks((last - first + chunk_size - 1) / chunk_size);
        tbb::parallel_for(std::uint32_t(0), std::uint32_t(chunks.size()), [&](std::uint32_t c) {
            const std::uint32_t begin = first + c * chunk_size, end = std::min(begin + chunk_size, last);
            chunks[c] = scene.has_media() ? tracer.trace<true>(begin, end, seed, pass, sampler)
                                          : tracer.trace<false>(begin, end, seed, pass, sampler);
        });
        if (first == 0) {
            std::size_t met_first = 0;
            for (const Chunk& chunk : chunks) met_first += chunk.kept.size();
            const double expected = double(met_first) * double(paths) / double(last);
            settings.paths.memory.require(
                std::min(expected, double(settings.max_photons)) * (sizeof(Candidate) + sizeof(Photon)),
                "the photons of " + std::to_string(paths) + " light paths");
        }
        for (Chunk& chunk : chunks) {
            kept.insert(kept.end(), chunk.kept.begin(), chunk.kept.end());
            met += chunk.met;
            rays.add(chunk.rays), tracking.add(chunk.tracking);
        }
        const int before = halvings;
        while (std::ldexp(double(met), -halvings) > double(settings.max_photons)) ++halvings;
        if (halvings > before) thin(kept, halvings);
    }
    PhotonSet set = split(std::move(kept), halvings);
    set.met = met, set.halvings = halvings, set.rays = rays, set.tracking = tracking;
    return set;
}

}  // namespace mote::gathering
