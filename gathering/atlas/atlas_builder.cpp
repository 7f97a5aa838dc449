#include "gathering/atlas/atlas_builder.h"

#include <fmt/format.h>

#include "core/objects/error.h"
#include "gathering/atlas/chart_texels.h"

namespace mote::gathering {

using namespace core;

AtlasBuilder::AtlasBuilder(SurfaceAtlas& atlas, const AtlasSettings& settings)
    : atlas_(atlas), settings_(settings), charts_(make_charts(atlas.surfaces(), settings.chart_cosine)) {
    for (const auto& shape : atlas.shapes()) sides_.push_back(sides_of(*shape));
}

AtlasBuilder::Grid AtlasBuilder::grid(const Chart& chart, float density) const {
    const auto along = [&](float length) {
        const double cells = std::ceil(double(length) * double(density) - 0.414);
        return std::uint32_t(std::clamp(cells, 1.0, 65535.0));
    };
    return {along(chart.width), along(chart.height)};
}

std::size_t AtlasBuilder::cells_at(float density) const {
    std::size_t sum = 0;
    for (const Chart& chart : charts_.charts)
        sum += std::size_t(sides_[chart.shape].count()) * grid(chart, density).cells();
    return sum;
}

/// The highest density whose cells the budget holds, by bisection: cells never get fewer with it.
float AtlasBuilder::density_for(std::size_t budget) const {
    float low = 0.0f, high = 1.0f / std::max(atlas_.surfaces().bounds.radius(), 1e-30f);
    while (cells_at(high) <= budget && high < 1e30f) low = high, high *= 2.0f;
    for (int i = 0; i < 24; ++i) {
        const float middle = 0.5f * (low + high);
        (cells_at(middle) <= budget ? low : high) = middle;
    }
    return low;
}

void AtlasBuilder::check_budget() const {
    const std::size_t least = cells_at(0.0f);
    if (least > settings_.texel_budget)
        throw InputError(
            fmt::format("the surfaces fall into so many pieces that an atlas needs {} texels at least; "
                        "texel_budget is {}",
                        least, settings_.texel_budget));
    if (settings_.texels_per_metre > 0.0f && cells_at(settings_.texels_per_metre) > settings_.texel_budget)
        throw InputError(
            fmt::format("an atlas of {:.4g} texels per metre has {} texels, and texel_budget is {}: "
                        "{:.4g} per metre fit",
                        settings_.texels_per_metre, cells_at(settings_.texels_per_metre),
                        settings_.texel_budget, density_for(settings_.texel_budget)));
}

void AtlasBuilder::build() {
    check_budget();
    density_ =
        settings_.texels_per_metre > 0.0f ? settings_.texels_per_metre : density_for(settings_.texel_budget);
    const std::size_t cells = cells_at(density_);
    settings_.memory.require(
        double(cells) * double(sizeof(AtlasTexel) + sizeof(std::uint32_t) + settings_.bytes_per_texel),
        fmt::format("an atlas of {} texels and the light that they receive", cells));
    atlas_.texels_per_metre_ = density_, atlas_.charts_ = charts_.charts.size();
    atlas_.cells_of_.resize(atlas_.surfaces().size());
    for (const Chart& chart : charts_.charts)
        if (sides_[chart.shape].count() > 0) add_chart(chart);
    atlas_.texels_.shrink_to_fit(), atlas_.cells_.shrink_to_fit();
}

void AtlasBuilder::add_chart(const Chart& chart) {
    const SurfaceTriangles& surfaces = atlas_.surfaces();
    const Grid g = grid(chart, density_);
    const Vec2 scale(chart.width > 0.0f ? float(g.columns) / chart.width : 0.0f,
                     chart.height > 0.0f ? float(g.rows) / chart.height : 0.0f);
    const auto triangles = charts_.of(chart);
    std::vector<std::array<Vec2, 3>> corners(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 d = surfaces.corners[triangles[i]][k] - chart.origin;
            corners[i][k] = Vec2(glm::dot(d, chart.s), glm::dot(d, chart.t)) * scale;
        }
    const ChartTexels texels = make_chart_texels(surfaces, triangles, corners, g.columns, g.rows);
    if (texels.texels.empty()) return;  // too thin for single precision
    SurfaceAtlas::TriangleCells place;
    place.cells = std::uint32_t(atlas_.cells_.size());
    place.last_x = float(g.columns - 1), place.last_y = float(g.rows - 1);
    for (const SurfaceSide side : {SurfaceSide::front, SurfaceSide::back}) {
        const bool back = side == SurfaceSide::back;
        if (!(back ? sides_[chart.shape].back : sides_[chart.shape].front)) continue;
        place.base[std::size_t(side)] = std::uint32_t(atlas_.texels_.size());
        for (AtlasTexel t : texels.texels) {
            t.side = side;
            if (back) t.normal = -t.normal, t.geometric_normal = -t.geometric_normal;
            atlas_.texels_.push_back(t);
        }
    }
    atlas_.cells_.insert(atlas_.cells_.end(), texels.texel_of_cell.begin(), texels.texel_of_cell.end());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        place.corner = corners[i][0];
        place.edge_u = corners[i][1] - corners[i][0], place.edge_v = corners[i][2] - corners[i][0];
        atlas_.cells_of_[triangles[i]] = place;
    }
}

}  // namespace mote::gathering
