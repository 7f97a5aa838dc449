// Light that the bound on the geometry term took, and its restoration: none, compensation in the passes,
// exact or approximate, or in image space after the last one.
//
// A scene file names a Residual by a nested <compensation>. It is prepared once for a view; every task has a
// TileResidual of its own. Calls are virtual per receiver, never per pair.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/film/film.h"
#include "core/objects/registry.h"
#include "core/render/integrator.h"
#include "core/scene/ray_walk.h"
#include "core/scene/scattering_vertex.h"
#include "core/scene/scene.h"
#include "lights/virtual_lights/vpl_gather.h"

namespace mote::compensation {

/// A view, as residuals see it.
struct ResidualView {
    const core::Scene& scene;
    const core::RenderOptions& options;
    float bound;            ///< b [1/m^2]; infinity: nothing is removed
    int max_depth;          ///< edges of a path as seen from the eye; -1: no limit
    std::size_t layer = 0;  ///< first of Residual::layers() in the film
};

/// Restores light at the sixteen receivers of a tile.
class TileResidual {
  public:
    virtual ~TileResidual() = default;
    /// Makes a vertex of an eye path a receiver. `throughput` is the weight of the eye path.
    virtual void add(int /*lane*/, const core::ScatteringVertex& /*vertex*/, const core::Rgb& /*throughput*/,
                     const core::MediumState& /*state*/, std::int32_t /*max_vpl_depth*/) {}
    /// The light of all receivers since the last call, those of VPLs in `range` times `vpl_scale`.
    virtual lights::TileLight run(const lights::VplRange& /*range*/, float /*vpl_scale*/) { return {}; }
};

class PreparedResidual {
  public:
    virtual ~PreparedResidual() = default;
    /// For one task; all references outlive it.
    virtual std::unique_ptr<TileResidual> for_task(const lights::VplSet& /*vpls*/,
                                                   lights::GatherScratch& /*scratch*/,
                                                   core::WalkContext& /*walk*/) {
        return std::make_unique<TileResidual>();
    }
    /// Before the tasks of a pass.
    virtual void begin(core::PassImage& /*image*/) {}
    /// The residual's own part of a pass, after all tasks. Returns false when cancelled.
    virtual bool pass(const core::PassContext& /*context*/, const lights::VplSet& /*vpls*/,
                      core::PassImage& /*image*/) {
        return true;
    }
    /// Works on the mean, after the last pass.
    virtual void finish(core::Film& /*film*/, core::CancelToken /*cancelled*/) {}
    virtual void add_statistics(core::Statistics& /*statistics*/) const {}
};

/// A nested <compensation> of a scene file. The class itself restores nothing.
class Residual : public core::Object {
  public:
    virtual std::unique_ptr<PreparedResidual> prepare(const ResidualView&) const {
        return std::make_unique<PreparedResidual>();
    }
    /// The method for receivers in media alone; null where it restores no light in the passes.
    virtual std::shared_ptr<const Residual> for_media() const { return std::make_shared<Residual>(); }
    /// Layers of the film that it fills: of light first scattered by surfaces, then in media. None: it
    /// restores nothing.
    virtual std::vector<core::Layer> layers(bool /*media*/) const { return {}; }
    bool restores() const { return !layers(false).empty(); }
    /// True where TileResidual restores light of such receivers, which image-space filters then take.
    virtual bool in_passes(bool /*surface*/) const { return false; }
    /// True where finish() works on the mean.
    virtual bool works_on_mean() const { return false; }
    /// If true, the VPLs may be shared out among receivers of a pixel.
    virtual bool shares_vpls() const { return true; }
    /// Receivers of a pixel and pass that it needs.
    virtual int eye_samples() const { return 1; }
    virtual void plan(core::Plan& plan, const core::Scene& scene, const core::Requirements& requirements,
                      float bound) const;

  protected:
    /// The two layers of compensation.
    static std::vector<core::Layer> compensation_layers(bool media);
};

/// none, exact, approximate.
void register_compensation(core::Registry& registry);

}  // namespace mote::compensation
