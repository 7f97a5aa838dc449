#include "core/render/error_source.h"

#include "core/render/control_passes.h"
#include "core/render/render_driver.h"

namespace mote::core {

namespace {

class NoErrorSource final : public ErrorSource {
  public:
    bool states_error() const override { return false; }
    std::optional<PictureError> error(const Film&) const override { return std::nullopt; }
};

class HalvesErrorSource final : public ErrorSource {
  public:
    bool states_error() const override { return true; }
    std::optional<PictureError> error(const Film& film) const override { return film.error(); }
};

class ControlErrorSource final : public ErrorSource {
  public:
    explicit ControlErrorSource(ControlPasses passes) : passes_(std::move(passes)) {}
    bool states_error() const override { return true; }
    void after_pass(const Film& film, const std::atomic<bool>& cancelled) override {
        passes_.follow(film, cancelled);
    }
    std::optional<PictureError> error(const Film& film) const override { return passes_.error(film); }
    void add_statistics(Statistics& statistics) const override { passes_.add_statistics(statistics); }

  private:
    ControlPasses passes_;
};

}  // namespace

std::unique_ptr<ErrorSource> make_error_source(const Scene& scene, const RenderRequest& request,
                                               CancelToken cancelled, const MemoryBudget& memory) {
    if (request.halves && request.noise_is_known) return std::make_unique<HalvesErrorSource>();
    if (!request.control || request.range) return std::make_unique<NoErrorSource>();
    return std::make_unique<ControlErrorSource>(
        ControlPasses(scene, *request.control, request.seed, cancelled, memory));
}

}  // namespace mote::core
