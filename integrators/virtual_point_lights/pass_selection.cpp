#include "integrators/virtual_point_lights/pass_selection.h"

#include <chrono>

#include "integrators/virtual_point_lights/selection_memory.h"

namespace mote::integrators {

using namespace core;

PassSelection::PassSelection(const Scene& scene, const SelectionSettings& settings,
                             const RenderOptions& options, float bound)
    : settings_(settings), options_(options), bound_(bound) {
    if (settings.by_matrix()) matrix_.emplace(scene, settings.matrix, options.seed);
}

void PassSelection::prepare(const lights::VplSet& vpls, const PassContext& context, const Passes& passes,
                            SharedCounters& counters) {
    check_selection_memory(settings_, vpls.lights.size());
    make_hierarchy(vpls);
    if (matrix_) make_matrix(vpls, context, passes, counters);
}

void PassSelection::make_hierarchy(const lights::VplSet& vpls) {
    hierarchy_.reset(), tree_.reset(), power_.reset();
    if (!settings_.by_hierarchy()) return;
    const auto begin = std::chrono::steady_clock::now();
    leaves_.emplace(vpls);
    if (settings_.cuts() || settings_.by_power())
        hierarchy_.emplace(*leaves_, settings_.max_bytes);
    else
        tree_.emplace(*leaves_, settings_.max_bytes);
    if (settings_.by_power()) power_.emplace(*hierarchy_);
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    bytes_ = std::max(bytes_, (hierarchy_ ? hierarchy_->memory_bytes() : tree_->memory_bytes()) +
                                  (power_ ? power_->memory_bytes() : 0));
}

/// The first of the passes that share rows makes them, whether or not it was made in this run.
void PassSelection::make_matrix(const lights::VplSet& vpls, const PassContext& context, const Passes& passes,
                                SharedCounters& counters) {
    const std::uint32_t share = settings_.shared_passes;
    const PassContext first{context.index / share * share, context.filter, context.cancelled};
    if (matrix_->pass() != first.index) {
        if (first.index == context.index)
            make_rows(vpls, first, passes, counters);
        else
            make_rows(passes.trace(first), first, passes, counters);
    }
    matrix_->use_for(context.index, vpls);
    selects_by_matrix_ = true;
}

void PassSelection::make_rows(const lights::VplSet& vpls, const PassContext& first, const Passes& passes,
                              SharedCounters& counters) {
    selects_by_matrix_ = false;  // receivers are looked for without
    const std::uint64_t key = hash_keys(options_.seed, first.index, 0x6d6174726978ull);
    const auto pixels = spread_pixels(options_.width, options_.height, eye_paths_for(settings_.matrix), key);
    const auto receivers = passes.find_receivers(first, vpls, pixels);
    matrix_->make(first.index, vpls, receivers, bound_, key, counters, first.cancelled);
}

SelectedBy PassSelection::by() const {
    return {hierarchy_ ? &*hierarchy_ : nullptr, tree_ ? &*tree_ : nullptr, power_ ? &*power_ : nullptr,
            selects_by_matrix_ ? &matrix_->selection() : nullptr};
}

void PassSelection::add_statistics(Statistics& statistics) const {
    if (settings_.by_hierarchy()) {
        statistics.seconds["light_hierarchy"] = seconds_;
        statistics.values["light_hierarchy_bytes"] = double(bytes_);
    }
    if (matrix_) matrix_->add_statistics(statistics);
}

}  // namespace mote::integrators
