// A render is a sum of independent passes (docs/design.md).
//
//   Integrator::prepare(scene, options) -> Estimator       once per view: maps, trees
//   Estimator::pass(context, layers)                       one independent, seeded estimate of the picture
//   Estimator::finish(film)                                optional post-processes on the mean
//
// The driver (render_driver.h) does everything else once for all integrators: sums, noise, stopping,
// progress, checkpoints, resume. (scene, seed, pass index) determines every bit of a pass, whatever the
// number of threads.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/film/pass_image.h"
#include "core/film/pixel_columns.h"
#include "core/film/tiles.h"
#include "core/math/sampler.h"
#include "core/math/vec.h"
#include "core/objects/cancellation.h"
#include "core/objects/memory_budget.h"
#include "core/objects/object.h"
#include "core/render/plan.h"
#include "core/render/point_lights.h"
#include "core/render/statistics.h"
#include "core/scene/requirements.h"

namespace mote::core {

class Film;
class Scene;

struct RenderOptions {
    std::uint64_t seed = 0;                    ///< of all random numbers
    int width = 0, height = 0;                 ///< of the film, or of the image of `columns` [pixels]
    SamplerKind sampler = SamplerKind::sobol;  ///< of eye and light paths
    CancelToken cancelled = {};                ///< prepare() may throw Cancelled once it is set
    /// Wanted cells (Layer::transport). The layers of the others may hold anything, and nothing should be
    /// spent on them.
    TransportSet cells = TransportSet::all();
    /// Passes fill the layer of light that is missing (Layer::missing), where the method has one.
    bool estimates_missing = false;
    MemoryBudget memory = {};   ///< what maps, trees, points and lights may take
    PixelColumns columns = {};  ///< what passes show instead of the film; Integrator::renders_columns()
};

/// Where within pixel (x, y) a sample falls so that its plain mean is the filtered picture (filter importance
/// sampling, Ernst et al. 2006): the filter's own distribution around the pixel centre. No sample is shared
/// between pixels, which keeps pixels independent and the sum of passes exact.
class PixelFilter {
  public:
    virtual ~PixelFilter() = default;
    virtual Vec2 sample_offset(const Vec2& u) const = 0;  ///< relative to the pixel centre [pixels]
    /// Density of sample_offset() [1/pixels^2]: the filter itself, normalised. What a light path that ends at
    /// `offset` from a pixel's centre counts there (see splat.h).
    virtual float pdf_area(const Vec2& offset) const = 0;
    /// The density is zero beyond this in x or in y [pixels].
    virtual float radius() const = 0;
};

/// One pass.
struct PassContext {
    std::uint32_t index;                 ///< which pass, of its part
    const PixelFilter& filter;           ///< where samples fall
    const std::atomic<bool>& cancelled;  ///< a cancelled pass returns false or throws Cancelled
    std::size_t part = 0;                ///< of the picture (Layer::part)
};

/// A method at work on one view.
class Estimator {
  public:
    virtual ~Estimator() = default;
    /// Fills the layers of a part with one independent estimate, and calls image.finish() for every pixel
    /// whose light is complete. Returns false, or throws Cancelled, when it was cancelled half-way.
    virtual bool pass(const PassContext& context, PassImage& image) = 0;
    /// Fills an image of those pixels with one layer, the light of a part that belongs to the beauty,
    /// independent of its passes (core/film/control_passes.h). Returns false, or throws, as pass(); always of
    /// the same pixels.
    virtual bool control_pass(const PixelColumns& /*pixels*/, const PassContext& /*context*/,
                              PassImage& /*light*/) {
        return false;
    }
    /// True for a part with control passes.
    virtual bool has_control_passes(std::size_t /*part*/) const { return false; }
    /// The part that has the next pass. Depends on the film alone, so that it is the same after an
    /// interruption.
    virtual std::size_t next_part(const Film& /*film*/) const { return 0; }
    /// The part that has the pass of this number, counted over all parts, before any pass was made. Throws
    /// InputError where that depends on what passes find: such a picture cannot be shared out by passes.
    virtual std::size_t part_of_pass(std::uint32_t /*number*/) const { return 0; }
    /// Post-processes on the mean, after the last pass. May throw Cancelled.
    virtual void finish(Film& /*film*/, CancelToken /*cancelled*/) {}
    /// finish() for a preview, or less of it in less time: then it returns false.
    virtual bool finish_preview(Film& film, CancelToken cancelled) {
        finish(film, cancelled);
        return true;
    }
    /// Wall time that finish() will take after another pass, where earlier calls have shown it [s]; nothing:
    /// about that of the last preview.
    virtual std::optional<double> seconds_to_finish(const Film& /*film*/) const { return std::nullopt; }
    /// Wall time so far of what finish() finds once, for all later calls [s].
    virtual double seconds_once() const { return 0.0; }
    /// Called where there is no time for what finish() would do after another pass, but not after those of
    /// the film: from then on it leaves that out.
    virtual void shorten_finish(const Film& /*film*/) {}
    /// True if finish() sets what it leaves of the variance (Film::set_mean, Film::set_halves): then the
    /// noise is that of the finished picture.
    virtual bool changes_noise(const Film& /*film*/) const { return false; }
    /// Adds this estimator's counters (rays, lookups, VPLs, ...).
    virtual void add_statistics(Statistics& /*statistics*/) const {}
};

/// A method with its parameters.
class Integrator : public Object {
  public:
    /// As in scene files.
    virtual std::string type() const = 0;
    /// True if Estimator::finish() reads and writes layers of the film: then it must be the film's only
    /// method.
    virtual bool works_on_mean() const { return false; }
    /// True where its pixels are independent of each other, whichever they are: prepare() can have
    /// RenderOptions::columns.
    virtual bool renders_columns() const { return false; }
    /// The layers it fills, in order; those that are not auxiliary add up to the beauty.
    virtual std::vector<Layer> layers(const Scene& scene) const = 0;
    /// Techniques that will run for this scene, with reasons.
    virtual Plan plan(const Scene& scene, const Requirements& requirements) const = 0;
    virtual std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const = 0;
    /// The points that bring light to its pixels; null where the method has none.
    virtual std::unique_ptr<PointLights> point_lights(const Scene& /*scene*/,
                                                      const RenderOptions& /*options*/) const {
        return nullptr;
    }
};

}  // namespace mote::core
