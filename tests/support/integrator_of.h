// An integrator for tests, from what its estimator does.
#pragma once

#include <memory>
#include <utility>

#include "core/render/integrator.h"

namespace mote::tests {

/// The layers of the estimator, else one of direct light. Each render begins with a copy of the estimator,
/// which is made from the arguments.
template <typename Pass>
class IntegratorOf final : public core::Integrator {
  public:
    template <typename... Arguments>
    explicit IntegratorOf(Arguments&&... arguments) : begin_(std::forward<Arguments>(arguments)...) {}
    std::string type() const override { return "of a test"; }
    std::vector<core::Layer> layers(const core::Scene&) const override {
        if constexpr (requires { Pass::layers(); })
            return Pass::layers();
        else
            return {{"direct", ""}};
    }
    core::Plan plan(const core::Scene&, const core::Requirements&) const override { return {}; }
    std::unique_ptr<core::Estimator> prepare(const core::Scene&, const core::RenderOptions&) const override {
        return std::make_unique<Pass>(begin_);
    }

  private:
    Pass begin_;
};

}  // namespace mote::tests
