#include "integrators/virtual_point_lights/vpl_light_lists.h"

#include <tbb/parallel_for.h>

#include "lights/shadow_maps/shadow_map_gather.h"
#include "screenspace/visibility/item_histogram.h"

namespace mote::integrators {

using namespace core;
using screenspace::no_item;

namespace {
constexpr int batch_t = 4;  // 2^4 x 2^4 lights are tiles of one picture
}

SurfaceItems::SurfaceItems(const Bounds3& bounds, int cells) : lower_(0.0f), per_metre_(0.0f), cells_(1) {
    if (bounds.empty()) return;
    const Vec3 extent = bounds.diagonal();
    const float longest = max_component(extent);
    lower_ = bounds.lower;
    if (!(longest > 0.0f) || !std::isfinite(longest)) return;
    per_metre_ = Vec3(float(cells) / longest);
    cells_ = glm::max(glm::ivec3(glm::ceil(extent * per_metre_)), glm::ivec3(1));
}

std::size_t SurfaceItems::item(const Vec3& position, const Vec3& normal) const {
    const glm::ivec3 cell =
        glm::clamp(glm::ivec3(glm::clamp((position - lower_) * per_metre_, Vec3(0.0f), Vec3(cells_))),
                   glm::ivec3(0), cells_ - 1);
    const Vec3 n = glm::abs(normal);
    const int axis = n.x >= n.y && n.x >= n.z ? 0 : n.y >= n.z ? 1 : 2;
    const std::size_t index =
        (std::size_t(cell.z) * std::size_t(cells_.y) + std::size_t(cell.y)) * std::size_t(cells_.x) +
        std::size_t(cell.x);
    return 6 * index + 2 * std::size_t(axis) + (normal[axis] < 0.0f);
}

VplLightLists::VplLightLists(const RayQueries& scene, const SurfaceItems& items, const lights::VplSet& vpls,
                             const LightListSettings& settings, CancelToken cancelled)
    : words_((vpls.lights.size() + 63) / 64), row_(items.count(), no_item) {
    std::vector<View> views;
    for (std::size_t j = 0; j < vpls.lights.size(); ++j)
        for (int side = 0; side < lights::views_of(vpls, j, settings.size).count; ++side)
            views.push_back({j, std::uint32_t(side)});
    constexpr std::size_t batch = std::size_t(1) << (2 * batch_t);
    for (std::size_t first = 0; first < views.size(); first += batch)
        look(scene, items, vpls, settings,
             std::span(views).subspan(first, std::min(batch, views.size() - first)), cancelled);
}

void VplLightLists::look(const RayQueries& scene, const SurfaceItems& items, const lights::VplSet& vpls,
                         const LightListSettings& settings, std::span<const View> views,
                         CancelToken cancelled) {
    constexpr std::size_t side = std::size_t(1) << batch_t;
    const auto size = std::size_t(settings.size), width = side * size;
    std::vector<std::uint32_t> picture(width * width, no_item);
    tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t v) {
        cancelled.check();
        const auto all = lights::views_of(vpls, views[v].light, settings.size);
        const lights::ShadowMapView& view = all.view[views[v].side];
        for (int texel = 0; texel < view.texels(); ++texel) {
            const Ray ray = view.ray(texel);
            const auto hit = scene.first_hit(ray);
            if (!hit) continue;
            const bool front = glm::dot(hit->geometric_normal, ray.direction) < 0.0f;
            const Vec3 towards_light = front ? hit->geometric_normal : -hit->geometric_normal;
            const std::size_t x = v % side * size + std::size_t(texel) % size;
            const std::size_t y = v / side * size + std::size_t(texel) / size;
            picture[y * width + x] = std::uint32_t(items.item(hit->position, towards_light));
        }
    });
    rays_.closest += views.size() * size * size;
    // Numbers without gaps, of what has been seen.
    auto rows = std::uint32_t(words_ > 0 ? lists_.size() / words_ : 0);
    for (std::uint32_t& item : picture) {
        if (item == no_item) continue;
        if (row_[item] == no_item) row_[item] = rows++;
        item = row_[item];
    }
    lists_.resize(rows * words_, 0);
    enter({int(width), int(width), picture}, views, batch_t);
}

void VplLightLists::enter(const screenspace::IdPicture& picture, std::span<const View> views, int t) {
    const auto rows = std::uint32_t(lists_.size() / words_);
    const screenspace::ItemHistogram histogram(picture, screenspace::ItemLayout::of_objects(rows, t));
    for (std::size_t row = 0; row < rows; ++row) {
        const auto bins = histogram.level(0).subspan(row << (2 * t), views.size());
        for (std::size_t v = 0; v < views.size(); ++v)
            if (bins[v] > 0)
                lists_[row * words_ + views[v].light / 64] |= std::uint64_t(1) << (views[v].light % 64);
    }
}

void VplLightLists::add(std::size_t item, std::span<std::uint64_t> list) const {
    if (row_[item] == no_item) return;
    for (std::size_t w = 0; w < words_; ++w) list[w] |= lists_[row_[item] * words_ + w];
}

}  // namespace mote::integrators
