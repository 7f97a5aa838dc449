#include "screenspace/visibility/conflict_graph.h"

#include <tbb/parallel_for.h>

#include <bit>
#include <cmath>

namespace mote::screenspace {

namespace {

/// Rectangles by the cells of a grid that they touch.
class Grid {
  public:
    explicit Grid(std::span<const PixelRectangle> rectangles) {
        std::size_t count = 0;
        double edges = 0.0;
        for (const PixelRectangle& r : rectangles) {
            if (r.empty()) continue;
            frame_ = count++ == 0 ? r
                                  : PixelRectangle{std::min(frame_.x0, r.x0), std::min(frame_.y0, r.y0),
                                                   std::max(frame_.x1, r.x1), std::max(frame_.y1, r.y1)};
            edges += 0.5 * (double(r.x1) - r.x0 + r.y1 - r.y0);
        }
        // As large as the rectangles in the mean, and no more cells than there are rectangles.
        const double mean = count > 0 ? edges / double(count) : 1.0;
        const double even = std::sqrt(double(frame_.area()) / double(std::max<std::size_t>(count, 1)));
        edge_ = std::max(1, int(std::max(mean, even)));
        columns_ = (frame_.x1 - frame_.x0) / edge_ + 1, rows_ = (frame_.y1 - frame_.y0) / edge_ + 1;
        first_.assign(std::size_t(columns_) * std::size_t(rows_) + 1, 0);
        for (const PixelRectangle& r : rectangles) for_each_cell(r, [&](std::size_t c) { ++first_[c + 1]; });
        for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
        items_.resize(first_.back());
        std::vector<std::size_t> next(first_);
        for (std::size_t i = 0; i < rectangles.size(); ++i)
            for_each_cell(rectangles[i], [&](std::size_t c) { items_[next[c]++] = std::uint32_t(i); });
    }
    template <typename Visit>
    void for_each_cell(const PixelRectangle& r, const Visit& visit) const {
        if (r.empty()) return;
        for (int y = row(r.y0); y <= row(r.y1 - 1); ++y)
            for (int x = column(r.x0); x <= column(r.x1 - 1); ++x) visit(cell(x, y));
    }
    std::span<const std::uint32_t> items(std::size_t c) const {
        return std::span(items_).subspan(first_[c], first_[c + 1] - first_[c]);
    }
    std::size_t cell_of(int x, int y) const { return cell(column(x), row(y)); }

  private:
    int column(int x) const { return (x - frame_.x0) / edge_; }
    int row(int y) const { return (y - frame_.y0) / edge_; }
    std::size_t cell(int x, int y) const { return std::size_t(y) * std::size_t(columns_) + std::size_t(x); }

    PixelRectangle frame_;
    int edge_ = 1, columns_ = 0, rows_ = 0;
    std::vector<std::size_t> first_;
    std::vector<std::uint32_t> items_;
};

/// Vertices by the number of their neighbours that are left, as lists: the next one is found, and one moves
/// down by one, in constant time.
class ByDegree {
  public:
    explicit ByDegree(const ConflictGraph& graph)
        : degree_(graph.size()), next_(graph.size()), before_(graph.size()) {
        for (std::size_t v = 0; v < graph.size(); ++v) {
            degree_[v] = graph.neighbours(v).size();
            if (degree_[v] >= head_.size()) head_.resize(degree_[v] + 1, none);
        }
        for (std::size_t v = graph.size(); v-- > 0;) link(std::uint32_t(v));
    }
    std::uint32_t take_least() {
        least_ = least_ > 0 ? least_ - 1 : 0;  // taking one away lowers others by one at most
        while (head_[least_] == none) ++least_;
        const std::uint32_t v = head_[least_];
        unlink(v), degree_[v] = gone;
        return v;
    }
    void lower(std::uint32_t v) {
        if (degree_[v] == gone) return;
        unlink(v), --degree_[v], link(v);
    }

  private:
    static constexpr std::uint32_t none = 0xffffffffu;
    static constexpr std::size_t gone = std::size_t(-1);

    void link(std::uint32_t v) {
        std::uint32_t& head = head_[degree_[v]];
        next_[v] = head, before_[v] = none;
        if (head != none) before_[head] = v;
        head = v;
    }
    void unlink(std::uint32_t v) {
        if (next_[v] != none) before_[next_[v]] = before_[v];
        (before_[v] != none ? next_[before_[v]] : head_[degree_[v]]) = next_[v];
    }

    std::vector<std::size_t> degree_;
    std::vector<std::uint32_t> next_, before_, head_;
    std::size_t least_ = 0;
};

}  // namespace

ConflictGraph::ConflictGraph(std::span<const PixelRectangle> rectangles) : first_(rectangles.size() + 1) {
    const Grid grid(rectangles);
    constexpr std::size_t chunk = 128;
    std::vector<std::vector<std::uint32_t>> found((rectangles.size() + chunk - 1) / chunk);
    tbb::parallel_for(std::size_t(0), found.size(), [&](std::size_t k) {
        for (std::size_t i = k * chunk; i < std::min((k + 1) * chunk, rectangles.size()); ++i) {
            const std::size_t before = found[k].size();
            const PixelRectangle& a = rectangles[i];
            grid.for_each_cell(a, [&](std::size_t c) {
                for (const std::uint32_t j : grid.items(c)) {
                    const PixelRectangle both = intersection(a, rectangles[j]);
                    // The cell of the overlap's corner counts it, the others do not.
                    if (j != i && !both.empty() && grid.cell_of(both.x0, both.y0) == c) found[k].push_back(j);
                }
            });
            first_[i + 1] = found[k].size() - before;
        }
    });
    for (std::size_t i = 0; i < rectangles.size(); ++i) first_[i + 1] += first_[i];
    neighbours_.reserve(first_.back());
    for (const auto& part : found) neighbours_.insert(neighbours_.end(), part.begin(), part.end());
}

std::vector<std::int8_t> colour(const ConflictGraph& graph, int channels) {
    std::vector<std::uint32_t> taken;  // in this order
    ByDegree left(graph);
    while (taken.size() < graph.size()) {
        taken.push_back(left.take_least());
        for (const std::uint32_t n : graph.neighbours(taken.back())) left.lower(n);
    }
    std::vector<std::int8_t> channel(graph.size(), conflict);
    const std::uint64_t all = channels < 64 ? (std::uint64_t(1) << channels) - 1 : ~std::uint64_t(0);
    for (; !taken.empty(); taken.pop_back()) {
        std::uint64_t used = 0;
        for (const std::uint32_t n : graph.neighbours(taken.back()))
            if (channel[n] != conflict) used |= std::uint64_t(1) << channel[n];
        if (const std::uint64_t free = all & ~used)
            channel[taken.back()] = std::int8_t(std::countr_zero(free));
    }
    return channel;
}

}  // namespace mote::screenspace
