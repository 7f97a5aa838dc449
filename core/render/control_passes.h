// Unbiased passes at a random subset of the pixels, with which the image of another method is compared
// (core/metrics/control_error.h): for methods whose own passes err alike, or pixels in common.
//
// One pixel is sampled in each block of 4 x 2, once; each control pass estimates its light anew. There are as
// many control passes as take a fixed fraction of the counted work of the image's passes, so their number,
// and with it the stated error, is a function of the film alone.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "core/film/film.h"
#include "core/render/integrator.h"

namespace mote::core {

class ControlPasses {
  public:
    /// Integrator::prepare() of `unbiased` at the subset of pixels. The scene must outlive this. Throws
    /// Cancelled, and OutOfMemory where their film has no room.
    ControlPasses(const Scene& scene, const Integrator& unbiased, std::uint64_t seed, CancelToken cancelled,
                  const MemoryBudget& memory);

    /// Control passes until they have their fraction of the work of the film's passes, two at least.
    void follow(const Film& film, const std::atomic<bool>& cancelled);
    /// Error of the film's image as it is shown; nothing with fewer than two control passes or too few
    /// pixels.
    std::optional<PictureError> error(const Film& film) const;
    std::uint32_t passes() const { return film_->pass_count(); }  ///< so far
    void add_statistics(Statistics& statistics) const;            ///< their number, rays and lookups

  private:
    struct Block {
        std::size_t pixel;  ///< that is sampled, in the image
        double pixels;      ///< number
    };
    double work_done() const;
    void sample_pixels(int width, int height, std::uint64_t seed);

    std::unique_ptr<PixelFilter> filter_;
    double work_fraction_;       ///< of the image's passes
    int columns_, rows_;         ///< of blocks
    std::vector<Block> blocks_;  ///< row by row
    std::vector<Vec2> corners_;  ///< of the sampled pixels
    std::unique_ptr<Estimator> estimator_;
    std::optional<Film> film_;
    std::optional<PassImage> image_;
};

}  // namespace mote::core
