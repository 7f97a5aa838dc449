// Selection of virtual point lights: which of a pass's VPLs light the receivers of a tile, and how often each
// counts.
//
// A scene file names a Selection by a nested <selection>. Every pass prepares it for its VPLs (VplSelector),
// every task has a TileSelector of its own, which gathers at one tile of sixteen receivers after the other
// and may learn from those before. Calls are virtual per tile and batch, never per pair. A method is a folder
// that its registration alone names (register_selection.cpp).
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/objects/error.h"
#include "core/objects/memory_budget.h"
#include "core/objects/object.h"
#include "core/render/plan.h"
#include "core/render/statistics.h"
#include "lights/virtual_lights/vpl_gather.h"

namespace mote::lights {

/// Where a receiver lies.
enum class ReceiverKind : std::uint8_t { surface, medium };

/// Light by ReceiverKind and lane.
using LightByKind = std::array<TileLight, 2>;

/// A vertex of an eye path that receives light.
struct PathReceiver {
    core::ScatteringVertex vertex;   ///< the receiver
    core::Rgb throughput{1.0f};      ///< of the eye path up to the vertex
    core::MediumState state;         ///< media there
    std::int32_t max_vpl_depth = 0;  ///< of the VPLs that it may be connected to
};

/// A VPL that a selector connected with a receiver.
struct ChosenVpl {
    std::size_t vpl;          ///< its index
    float weight;             ///< 1/p
    std::size_t cluster = 0;  ///< VPLs that it represents; 0: not one of a cluster
    core::Rgb light{0.0f};    ///< at the receiver
};

/// A pass, as selectors see it.
struct SelectionPass {
    const core::RayQueries& scene;     ///< where they are
    const VplSet& vpls;                ///< outlives the selector
    float bound;                       ///< b of the geometry term [1/m^2], infinity for none
    std::uint64_t key;                 ///< determines the random numbers of preparing
    core::RayCounters& rays;           ///< counted up
    core::TrackingCounters& tracking;  ///< counted up
    core::Statistics& statistics;      ///< of all passes
    core::CancelToken cancelled;       ///< preparing throws Cancelled once it is set
    /// On about Selection::receiver_paths() eye paths, spread over the image.
    std::span<const PathReceiver> receivers = {};
    core::MemoryBudget memory = {};  ///< of the selector
};

/// Gathers for one task.
class TileSelector {
  public:
    virtual ~TileSelector() = default;

    /// Light of the VPLs at the receivers, by lane. `range`: the VPLs meant, where the selection shares them
    /// out. `rng` chooses. Receivers that are to be gathered together are only copied, with the vertices that
    /// they refer to.
    virtual TileLight gather(const GatherContext& context, ReceiverTile& receivers, const VplRange& range,
                             BatchVisibility& visibility, core::Rng& rng) = 0;
    /// Light at all receivers that were copied since the last call; called once a pixel and pass.
    virtual LightByKind gather_copied(const GatherContext&, core::Rng&) { return {}; }
    /// Scattering points of an eye ray that are receivers. More take memory and compensation, and gain little
    /// where they meet no more VPLs (docs/methods/media.md).
    virtual std::size_t max_points() const { return 2; }
    /// VPLs that brought a lane the light of the last gather() or gather_copied(), for selectors that connect
    /// them without the BatchVisibility: until the next call.
    virtual std::vector<ChosenVpl> chosen(int /*lane*/) const { return {}; }
    /// Adds what was counted since the selector was made.
    virtual void add_statistics(core::Statistics&) const {}

  protected:
    /// Kind of the first receiver that is not idle.
    static ReceiverKind kind_of(const ReceiverLanes& receivers);
    /// The lanes of one kind, others idle.
    static ReceiverTile lanes_of(const ReceiverTile& receivers, ReceiverKind kind);
    /// The generator of one tile's choices: one number of `rng`, in a stream apart from eye paths.
    static core::Rng choices_of(core::Rng& rng) {
        return core::Rng(core::hash_keys(rng.next_u32(), 0x73656c656374ull));
    }
};

/// A selection prepared for the VPLs of one pass: makes the selector of a task, which keeps what it needs and
/// may outlive it. Safe from many threads.
using VplSelector = std::function<std::unique_ptr<TileSelector>()>;

/// Options of a many-light pass that not every selection goes with.
struct GatherOptions {
    bool interleaving = false;           ///< neighbouring pixels have different VPLs
    bool compensation = false;           ///< of what the bound takes
    bool roughness_clamping = false;     ///< of glossy peaks
    bool shadow_maps = false;            ///< volumetric shadow maps instead of shadow rays
    bool imperfect_shadow_maps = false;  ///< imperfect ones
};

/// Sizes that a plan states costs by.
struct SelectionSize {
    double vpls = 0.0;   ///< of a pass, about
    double pairs = 0.0;  ///< points of a pass that gather, about
};

/// A nested <selection> of a scene file.
class Selection : public core::Object {
  public:
    /// Throws core::InputError where memory_bytes() exceeds max_bytes, core::Cancelled.
    virtual VplSelector prepare(const SelectionPass& pass) const = 0;
    /// If true, every receiver takes all VPLs, which points and pixels may share out.
    virtual bool takes_all() const { return false; }
    /// True where the mean of what it gathers is the light of all VPLs: the integrator is then called
    /// unbiased where its bound and its compensation allow it. The plan says so, tests hold it to it.
    virtual bool is_unbiased() const { return false; }
    /// Name of an option that this selection does not go with; empty where there is none.
    virtual std::string excludes(const GatherOptions& options) const;
    /// Eye paths whose receivers prepare() evaluates.
    virtual std::size_t receiver_paths() const { return 0; }
    /// Largest size in memory while prepare() works and of what its selectors share, besides the VPLs
    /// [bytes].
    virtual std::size_t memory_bytes(std::size_t vpls) const = 0;
    /// States its settings and costs.
    virtual void plan(core::Plan& plan, const SelectionSize& size) const = 0;

    /// Limit of memory_bytes(): ten million VPLs fit several times, and a machine of 8 GB stays usable.
    static constexpr std::size_t max_bytes = std::size_t(4) << 30;
    core::SourceLocation where;  ///< of its element in the scene file

  protected:
    /// Throws core::InputError where the VPLs need more than max_bytes, core::OutOfMemory where they need
    /// more than the pass has.
    void check_memory(const SelectionPass& pass) const;
    /// States what memory_bytes() says.
    void plan_memory(core::Plan& plan, const std::string& topic, const SelectionSize& size) const;
};

/// All VPLs at every receiver.
std::shared_ptr<Selection> all_vpls();
/// Resampled importance sampling: of `candidates` from a cut each pixel chooses `samples`.
std::shared_ptr<Selection> resampled_vpls(std::uint32_t candidates, std::uint32_t samples);

}  // namespace mote::lights
