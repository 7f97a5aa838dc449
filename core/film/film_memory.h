// Memory that a film takes, known before it is made.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/film/pass_split.h"
#include "core/objects/memory_budget.h"

namespace mote::core {

/// Bytes of a film with so many passes, of the image of a pass with the estimate of the noise, and of the
/// finished picture beside the film.
class FilmMemory {
  public:
    /// `passes`: nothing where a limit in time or noise ends the render; then as many as a thousand.
    FilmMemory(int width, int height, std::span<const Layer> layers, bool all_squares = false,
               std::optional<std::uint32_t> passes = {}, PassSplit split = PassSplit::whole);

    double begin() const { return begin_; }  ///< of a Film without passes [B]
    double sums() const { return sums_; }    ///< of a Film after all passes [B]
    double peak() const;                     ///< the most of a render from its first pass to its picture [B]
    /// "a film of 640 x 400 pixels and 3 layers"
    std::string purpose() const;
    /// Throws OutOfMemory where the budget has no room for peak() and `more` bytes, with the largest film of
    /// this shape that it has room for.
    void require(const MemoryBudget& memory, double more = 0.0) const;

  private:
    int width_, height_;
    std::size_t layers_;
    double begin_, sums_, pass_, picture_;
};

}  // namespace mote::core
