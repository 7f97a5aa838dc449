#include "lights/visibility/visibility.h"

#include "core/parameters/add_type.h"

namespace mote::lights {

using namespace core;

namespace {

class PreparedTraced final : public PreparedVisibility {
  public:
    TileLight gather(std::size_t, const TileGather& g) override {
        TracedVisibility visibility(g.context, g.receivers);
        return g.selector.gather(g.context, g.receivers, g.range, visibility, g.rng);
    }
};

class Traced final : public Visibility {
  public:
    bool is_exact() const override { return true; }
    std::unique_ptr<PreparedVisibility> prepare(const LitScene&, std::uint64_t,
                                                const MemoryBudget&) const override {
        return prepare_traced_visibility();
    }
    void plan(Plan& plan, const LitScene&, double) const override {
        plan.run("visibility", "shadow rays, sixteen at a time", "exact");
    }
};

}  // namespace

std::shared_ptr<Visibility> traced_visibility() { return std::make_shared<Traced>(); }
std::unique_ptr<PreparedVisibility> prepare_traced_visibility() { return std::make_unique<PreparedTraced>(); }

void register_visibility(Registry& registry) {
    add_type(registry, Category::visibility, "traced", "Shadow rays, and tracking through media: exact.",
             R"(<visibility type="traced"/>)", traced_visibility);
    register_imperfect_visibility(registry);
    register_shadow_map_visibility(registry);
}

}  // namespace mote::lights
