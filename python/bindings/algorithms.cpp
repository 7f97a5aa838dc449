// Methods over arrays of a host: a hierarchy over its lights, epipolar sampling of its depth buffer,
// upsampling, visibility queries.
#include "core/scene/light_tree.h"
#include "python/bindings/arrays.h"
#include "screenspace/epipolar/depth_buffer.h"
#include "screenspace/upsampling/upsampled_picture.h"
#include "screenspace/visibility/exact_counts.h"
#include "session/host/host_triangles.h"

namespace mote::python {

namespace {

using core::Rgb, core::Vec3;
using Corners = nb::ndarray<const std::uint32_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Depth = nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>;  ///< [row][column]
using Items = nb::ndarray<const std::uint32_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Queries = nb::ndarray<const std::int64_t, nb::shape<-1, 5>, nb::c_contig, nb::device::cpu>;

nb::object picture_of(const std::vector<Rgb>& light, std::size_t height, std::size_t width) {
    std::vector<float> values;
    for (const Rgb& l : light) values.insert(values.end(), {l.x, l.y, l.z});
    return array_of(std::move(values), height, width, 3);
}

/// Lights as boxes with one direction each, or none.
core::LightTree light_tree(const Vectors& lower, const Vectors& upper, const Vectors& normal,
                           const std::vector<double>& intensity) {
    if (intensity.empty() || lower.shape(0) != intensity.size() || upper.shape(0) != intensity.size() ||
        normal.shape(0) != intensity.size())
        throw std::invalid_argument(
            "boxes, normals and intensities have one entry a light, and there is one");
    std::vector<core::LightBounds> lights(intensity.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        lights[i].box = {vec3(lower.data() + 3 * i), vec3(upper.data() + 3 * i)};
        const Vec3 n = vec3(normal.data() + 3 * i);
        if (n != Vec3(0.0f)) lights[i].normals = core::DirectionCone::of(n);
        if (!(intensity[i] > 0.0) || !std::isfinite(intensity[i]))
            throw std::invalid_argument("a light has an intensity above 0");
        lights[i].intensity = intensity[i];
    }
    return core::LightTree(lights);
}

core::LightReceiver receiver(const Triple& position, const Triple& normal) {
    return {Vec3(float(position[0]), float(position[1]), float(position[2])),
            Vec3(float(normal[0]), float(normal[1]), float(normal[2]))};
}

Rgb radiance(const nb::object& value) {
    const auto three = nb::cast<Triple>(value);
    return {float(three[0]), float(three[1]), float(three[2])};
}

nb::tuple epipolar(const Depth& depth, const nb::callable& march, double focal_length, const Triple& lamp,
                   std::pair<double, double> centre, double far_distance, int lines, int samples,
                   double tolerance) {
    screenspace::DepthBuffer buffer;
    buffer.width = int(depth.shape(1)), buffer.height = int(depth.shape(0));
    buffer.depth = {depth.data(), depth.size()};
    buffer.far_distance = far_distance, buffer.focal_length = focal_length;
    buffer.centre = {centre.first, centre.second}, buffer.lamp = {lamp[0], lamp[1], lamp[2]};
    screenspace::LineSampling sampling;
    sampling.initial = samples, sampling.tolerance = float(tolerance);
    const auto found = screenspace::light_over(
        buffer, lines, sampling,
        [&](const screenspace::Vec2d& film, double d) { return radiance(march(film.x, film.y, d)); });
    return nb::make_tuple(picture_of(found.light, depth.shape(0), depth.shape(1)), found.marched);
}

nb::tuple upsample(const Pixels& position, const Pixels& normal, const std::optional<Pixels>& albedo,
                   double focal_length, int spacing, const nb::callable& shade) {
    const auto p = colours(position), n = colours(normal), a = albedo ? colours(*albedo) : std::vector<Rgb>();
    const auto found =
        screenspace::upsampled({int(position.shape(1)), int(position.shape(0)), focal_length, p, n, a},
                               spacing, [&](int x, int y) { return radiance(shade(x, y)); });
    return nb::make_tuple(picture_of(found.light, position.shape(0), position.shape(1)), found.shaded);
}

std::vector<Vec3> rows(const Vectors& values) {
    std::vector<Vec3> result;
    for (std::size_t i = 0; i < values.shape(0); ++i) result.push_back(vec3(values.data() + 3 * i));
    return result;
}
std::vector<std::array<std::uint32_t, 3>> rows(const Corners& values) {
    std::vector<std::array<std::uint32_t, 3>> result;
    for (std::size_t i = 0; i < values.shape(0); ++i) {
        const std::uint32_t* corners = values.data() + 3 * i;
        result.push_back({corners[0], corners[1], corners[2]});
    }
    return result;
}

nb::object micro_irradiance(const Vectors& corners, const Corners& triangles, const Vectors& radiance,
                            const Vectors& position, const Vectors& normal, std::uint32_t points,
                            std::uint32_t side, std::uint32_t passes, std::uint64_t seed) {
    const auto mesh_corners = rows(corners);
    const auto mesh_triangles = rows(triangles);
    std::vector<float> values;
    for (const Rgb& e : session::micro_irradiance({mesh_corners, mesh_triangles}, rows(radiance),
                                                  rows(position), rows(normal), {points, side, passes, seed}))
        values.insert(values.end(), {e.x, e.y, e.z});
    return array_of(std::move(values), position.shape(0), 3);
}

nb::tuple bundle_links(const Vectors& corners, const Corners& triangles, const Triple& direction,
                       double spacing, std::pair<double, double> offset) {
    const auto mesh_corners = rows(corners);
    const auto mesh_triangles = rows(triangles);
    const auto found = session::bundle_links({mesh_corners, mesh_triangles}, vec3(direction), float(spacing),
                                             {float(offset.first), float(offset.second)});
    std::vector<std::uint32_t> pairs;
    std::vector<double> areas;
    for (const session::BundleLink& link : found)
        pairs.insert(pairs.end(), {link.from, link.to}), areas.push_back(link.area);
    return nb::make_tuple(array_of(std::move(pairs), found.size(), 2),
                          array_of(std::move(areas), found.size()));
}

nb::object count_visible(const Items& items, std::uint32_t count, const Queries& queries) {
    const screenspace::IdPicture picture{
        int(items.shape(1)), int(items.shape(0)), {items.data(), items.size()}};
    const screenspace::ExactCounts counts(picture, count);
    std::vector<std::uint32_t> pixels;
    for (std::size_t i = 0; i < queries.shape(0); ++i) {
        const std::int64_t* q = queries.data() + 5 * i;
        if (q[0] < 0 || q[0] >= std::int64_t(count)) throw std::out_of_range("there is no such item");
        pixels.push_back(counts.pixels({std::uint32_t(q[0]), {int(q[1]), int(q[2]), int(q[3]), int(q[4])}}));
    }
    return array_of(std::move(pixels), queries.shape(0));
}

}  // namespace

void bind_algorithms(nb::module_& m) {
    nb::class_<core::LightTree>(m, "LightTree", "A hierarchy over lights.")
        .def("__len__", &core::LightTree::size)
        .def("sample",
             [](const core::LightTree& tree, const Triple& position, const Triple& normal, double u) {
                 if (!(u >= 0.0 && u < 1.0)) throw std::invalid_argument("u is in [0, 1)");
                 const auto choice = tree.sample(receiver(position, normal), u);
                 return std::make_pair(choice.light, choice.probability);
             })
        .def("probability", [](const core::LightTree& tree, const Triple& position, const Triple& normal,
                               std::uint32_t light) {
            if (light >= tree.size()) throw std::out_of_range("there is no such light");
            return tree.probability(receiver(position, normal), light);
        });
    m.def("light_tree", &light_tree);
    m.def("epipolar", &epipolar);
    m.def("upsample", &upsample, nb::arg("position"), nb::arg("normal"), nb::arg("albedo").none(),
          nb::arg("focal_length"), nb::arg("spacing"), nb::arg("shade"));
    m.def("count_visible", &count_visible);
    m.def("micro_irradiance", &micro_irradiance);
    m.def("bundle_links", &bundle_links);
}

}  // namespace mote::python
