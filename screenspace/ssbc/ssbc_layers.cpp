#include "screenspace/ssbc/ssbc_layers.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "screenspace/g_buffer/g_buffer.h"

namespace mote::screenspace {

namespace {

template <class T>
void put(const std::vector<T>& from, std::vector<T>& to, std::size_t at) {
    std::copy(from.begin(), from.end(), to.begin() + std::ptrdiff_t(at));
}

void put(const SsbcSurfaces& from, SsbcSurfaces& to, int row) {
    const std::size_t at = std::size_t(row) * std::size_t(to.width);
    put(from.position, to.position, at), put(from.normal, to.normal, at), put(from.facing, to.facing, at);
    put(from.area, to.area, at), put(from.reflectance, to.reflectance, at);
}

}  // namespace

std::vector<SsbcSurfaces> hidden_sides(std::span<const GBuffer> layers) {
    std::vector<SsbcSurfaces> sides;
    for (std::size_t k = 0; k < layers.size() && layers.size() > 1; ++k) {
        if (k > 0) sides.push_back(ssbc_surfaces(layers[k]));
        sides.push_back(ssbc_surfaces(seen_from_behind(layers[k])));
    }
    return sides;
}

std::string hidden_side_name(std::size_t side) {
    return std::to_string(side / 2 + side % 2 + 1) + (side % 2 == 0 ? "_back" : "");
}

SideLayout side_layout(int height, std::size_t hidden) {
    constexpr int node = 64;  // pixels along a node of the levels that are summed, and more
    if (hidden == 0) return {height, height, 1};
    return {height, (height + node - 1) / node * node, 1 + int(hidden)};
}

SsbcSurfaces in_one_picture(const SsbcSurfaces& visible, const std::vector<const SsbcSurfaces*>& hidden) {
    if (hidden.empty()) return visible;
    const SideLayout layout = side_layout(visible.height, hidden.size());
    SsbcSurfaces all(visible.width, layout.total_height());
    put(visible, all, 0);
    for (std::size_t s = 0; s < hidden.size(); ++s) {
        if (hidden[s]->width != visible.width || hidden[s]->height != visible.height)
            throw std::invalid_argument("a hidden side has not the size of the picture");
        put(*hidden[s], all, int(s + 1) * layout.pitch);
    }
    return all;
}

}  // namespace mote::screenspace
