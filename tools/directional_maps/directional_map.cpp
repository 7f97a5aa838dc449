#include "tools/directional_maps/directional_map.h"

#include <fmt/format.h>

#include "core/objects/error.h"
#include "lights/directional_maps/octahedral_map.h"
#include "tools/directional_maps/directional_map_kinds.h"

namespace mote::tools {

using namespace core;
using namespace lights;

namespace {

constexpr std::array<MapKindName, 8> kind_names{{{MapKind::octahedral, "octahedral"},
                                                 {MapKind::octahedral_rectangle, "octahedral_rectangle"},
                                                 {MapKind::octahedral_perspective, "octahedral_perspective"},
                                                 {MapKind::hemi_octahedral, "hemi_octahedral"},
                                                 {MapKind::cube, "cube"},
                                                 {MapKind::latitude_longitude, "latitude_longitude"},
                                                 {MapKind::sphere, "sphere"},
                                                 {MapKind::paraboloid, "paraboloid"}}};

}  // namespace

std::span<const MapKindName> map_kinds() { return kind_names; }

MapKind parse_map_kind(std::string_view name) {
    std::vector<std::string> names;
    for (const MapKindName& known : kind_names) {
        if (known.name == name) return known.kind;
        names.emplace_back(known.name);
    }
    throw InputError(fmt::format("no directional map '{}'{}", printable(name), suggestion(name, names)));
}

DirectionalMap::Place DirectionalMap::place(int texel) const {
    const int row = texel / width_;
    return {row / height_, texel % width_, row % height_};
}

Vec2 DirectionalMap::centre(const Place& p) const {
    return {(float(p.i) + 0.5f) / float(width_), (float(p.j) + 0.5f) / float(height_)};
}

int DirectionalMap::texel(const Vec3& d) const {
    const MapPoint p = project(d);
    return index({p.face, texel_index(p.uv.x, width_), texel_index(p.uv.y, height_)});
}

Vec3 DirectionalMap::direction(int texel) const {
    const Place p = place(texel);
    return unproject({p.face, centre(p)});
}

double DirectionalMap::used_fraction(int) const { return 1.0; }

double DirectionalMap::sampling_ratio(int texel) const {
    const double share = used_fraction(texel);
    if (share == 0.0) return 0.0;
    const double even = domain() / (used_fraction() * double(texels()));
    return even * share / solid_angle(texel);
}

FilterTaps DirectionalMap::taps(const Vec3& d) const {
    const MapPoint p = project(d);
    const TexelCell cell(p.uv, width_, height_);
    const std::array<float, 4> weights = cell.weights();
    FilterTaps taps;
    for (int k = 0; k < 4; ++k) {
        const Place place{p.face, cell.i + (k & 1), cell.j + (k >> 1)};
        const float weight = weights[std::size_t(k)];
        if (inside(place))
            taps.add(index(place), weight);
        else if (weight != 0.0f)
            add_beyond_edge(taps, place, weight);
    }
    return taps;
}

void DirectionalMap::add_beyond_edge(FilterTaps& taps, const Place& p, float weight) const {
    add_clamped(taps, project(unproject({p.face, centre(p)})), weight);
}

void DirectionalMap::add_clamped(FilterTaps& taps, const MapPoint& p, float weight) const {
    const TexelCell cell(p.uv, width_, height_);
    const std::array<float, 4> weights = cell.weights();
    for (int k = 0; k < 4; ++k) {
        const int i = std::clamp(cell.i + (k & 1), 0, width_ - 1);
        const int j = std::clamp(cell.j + (k >> 1), 0, height_ - 1);
        taps.add(index({p.face, i, j}), weight * weights[std::size_t(k)]);
    }
}

std::unique_ptr<DirectionalMap> make_directional_map(MapKind kind, int size) {
    if (size < 1 || size > 16384)
        throw InputError(fmt::format("a directional map of size {}: it must be from 1 to 16384", size));
    switch (kind) {
        case MapKind::octahedral:
            return make_square_octahedral_map(size);
        case MapKind::octahedral_rectangle:
            return make_rectangle_octahedral_map(size);
        case MapKind::octahedral_perspective:
            return make_perspective_octahedral_map(size, std::sqrt(2.0f));
        case MapKind::hemi_octahedral:
            return make_hemi_octahedral_map(size);
        case MapKind::cube:
            return make_cube_map(size);
        case MapKind::latitude_longitude:
            return make_latitude_longitude_map(size);
        case MapKind::sphere:
            return make_sphere_map(size);
        case MapKind::paraboloid:
            return make_paraboloid_map(size);
    }
    throw std::logic_error("no such kind of directional map");
}

}  // namespace mote::tools
