// Maps of texels over the sphere of directions: those of Engelhardt 2013, Chs. 5 and 7, behind one interface,
// to compare them and to store anything over directions.
//
// z is up in all of them. A map is one or more faces of width * height texels; texels are numbered face by
// face, row by row. Every call is virtual: loops that cannot pay for it use the structs of octahedral_map.h.
#pragma once

#include <array>
#include <cassert>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/math/vec.h"

namespace mote::tools {

enum class MapKind {
    octahedral,              ///< planar projection, all directions on one square (Eqs. 7.1 and 7.2)
    octahedral_rectangle,    ///< planar projection, the two hemispheres side by side, 2:1 (Eq. 7.3)
    octahedral_perspective,  ///< an octant is what a camera at 45 degrees of elevation sees of it
                             ///< (Sec. 7.1.2)
    hemi_octahedral,         ///< planar projection, the hemisphere z >= 0 on one square
    cube,                    ///< six squares (Sec. 5.1.3)
    latitude_longitude,      ///< 2:1 (Sec. 5.1.1)
    sphere,                  ///< the picture of a mirror sphere (Sec. 5.1.2)
    paraboloid               ///< the pictures of two mirror paraboloids (Sec. 5.1.4)
};

struct MapKindName {
    MapKind kind;
    std::string_view name;
};
std::span<const MapKindName> map_kinds();
/// Throws InputError with the nearest name.
MapKind parse_map_kind(std::string_view name);

struct MapPoint {
    int face = 0;
    core::Vec2 uv;  ///< in [0, 1]^2, rows along y
};

/// Texels and weights of a filtered lookup. The weights add up to one; some may be negative, at the corners
/// of a cube.
struct FilterTaps {
    int count = 0;
    std::array<int, 20> texel{};
    std::array<float, 20> weight{};

    void add(int index, float w) {
        if (w == 0.0f) return;
        assert(count < int(texel.size()));
        texel[std::size_t(count)] = index;
        weight[std::size_t(count++)] = w;
    }
};

class DirectionalMap {
  public:
    virtual ~DirectionalMap() = default;

    int faces() const { return faces_; }
    int width() const { return width_; }    ///< of one face
    int height() const { return height_; }  ///< of one face
    int texels() const { return faces_ * width_ * height_; }
    /// The solid angle of all that is mapped: 4 pi, or 2 pi for a hemisphere.
    virtual double domain() const { return 4.0 * 3.14159265358979323846; }

    /// `d` must not be zero; it need not have unit length.
    virtual MapPoint project(const core::Vec3& d) const = 0;
    /// A unit vector. Where the picture of all directions does not fill the face (a disc in a square), its
    /// continuation: every texel's centre has a direction, and must be given a value for filtered lookups.
    virtual core::Vec3 unproject(const MapPoint& p) const = 0;

    int texel(const core::Vec3& d) const;
    core::Vec3 direction(int texel) const;

    /// Solid angle of the used part of the texel [sr]: 0 in the corners around a disc.
    virtual double solid_angle(int texel) const = 0;
    /// How much of the texel belongs to the picture, in [0, 1].
    virtual double used_fraction(int texel) const;
    /// Used fraction of the whole map: pi / 4 where discs lie in squares.
    virtual double used_fraction() const { return 1.0; }
    /// Density of texels around this one, relative to as many texels spread evenly: above 1 is oversampling.
    /// Only what belongs to the picture counts as texels. 0 where a texel is not used.
    double sampling_ratio(int texel) const;

    /// Texels and weights of the bilinear lookup, continued over every edge of every face.
    FilterTaps taps(const core::Vec3& d) const;

  protected:
    DirectionalMap(int faces, int width, int height) : faces_(faces), width_(width), height_(height) {}

    struct Place {
        int face, i, j;
    };
    Place place(int texel) const;
    int index(const Place& p) const { return (p.face * height_ + p.j) * width_ + p.i; }
    core::Vec2 centre(const Place& p) const;

    /// Adds what lies at a place just beyond an edge of its face, i = -1 or width, or j = -1 or height.
    /// Unless a map overrides it: the bilinear lookup, within one face, at the direction of that place.
    virtual void add_beyond_edge(FilterTaps& taps, const Place& p, float weight) const;
    /// Bilinear within the face, which ends at the centres of its outer texels.
    void add_clamped(FilterTaps& taps, const MapPoint& p, float weight) const;

  private:
    bool inside(const Place& p) const { return p.i >= 0 && p.i < width_ && p.j >= 0 && p.j < height_; }

    int faces_, width_, height_;
};

/// The edge of a face has `size` texels; the longer one of a 2:1 map has twice as many. Throws InputError
/// unless size is in [1, 16384].
std::unique_ptr<DirectionalMap> make_directional_map(MapKind kind, int size);

/// The perspective kind with cameras along (+-1, +-1, +-up). With up = 1 they look straight at the faces of
/// the octahedron, and the map is the planar one: a projection from the middle onto the faces, too.
std::unique_ptr<DirectionalMap> make_perspective_octahedral_map(int size, float up);

/// The filtered value that a map of `values`, one for each texel, has in the direction d.
template <class Value>
Value bilinear(const DirectionalMap& map, std::span<const Value> values, const core::Vec3& d) {
    const FilterTaps taps = map.taps(d);
    Value sum{};
    for (std::size_t k = 0; k < std::size_t(taps.count); ++k)
        sum += taps.weight[k] * values[std::size_t(taps.texel[k])];
    return sum;
}

}  // namespace mote::tools
