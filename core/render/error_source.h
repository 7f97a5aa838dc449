// How the error of an image becomes known while it is rendered: not at all, from the two halves of its
// passes, or from control passes of another method.
#pragma once

#include <atomic>
#include <memory>
#include <optional>

#include "core/film/film.h"
#include "core/render/integrator.h"

namespace mote::core {

struct RenderRequest;

class ErrorSource {
  public:
    virtual ~ErrorSource() = default;
    /// False: the error is never known.
    virtual bool states_error() const = 0;
    /// After each pass of the film, and before the first of a film that has passes already.
    virtual void after_pass(const Film& /*film*/, const std::atomic<bool>& /*cancelled*/) {}
    /// Error of the film's image as it is shown; nothing where it is not known yet.
    virtual std::optional<PictureError> error(const Film& film) const = 0;
    /// Adds counters of work of its own.
    virtual void add_statistics(Statistics& /*statistics*/) const {}
};

/// As RenderRequest::halves and RenderRequest::control request. Throws Cancelled, and OutOfMemory.
std::unique_ptr<ErrorSource> make_error_source(const Scene& scene, const RenderRequest& request,
                                               CancelToken cancelled, const MemoryBudget& memory);

}  // namespace mote::core
