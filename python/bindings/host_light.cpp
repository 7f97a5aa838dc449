// Many-light methods over the rays of a host's functions.
#include "session/host/host_light.h"

#include <nanobind/stl/tuple.h>

#include "python/bindings/arrays.h"

namespace mote::python {

namespace {

using core::Rgb, core::Vec3;
using Materials = nb::ndarray<const std::uint32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Hit = std::optional<std::tuple<double, Triple, std::uint32_t>>;

Triple triple(const Vec3& v) { return {v.x, v.y, v.z}; }

/// Functions of Python with the scene and the light that call them. Made, used and destroyed with the
/// interpreter's lock, which is released while light is computed: threads take it for each call.
class PythonHostLight {
  public:
    PythonHostLight(nb::callable first_hit, nb::object find_occluded, const Vectors& reflectance,
                    const Vectors& lamps, const Vectors& intensities, const std::pair<Triple, Triple>& bounds,
                    const Triple& scattering, const Triple& absorption, double anisotropy,
                    const std::string& method, const std::string& selection, std::uint32_t paths,
                    double bound, int compensation_steps, std::uint32_t neighbours, std::uint64_t seed)
        : first_hit_(std::move(first_hit)), find_occluded_(std::move(find_occluded)) {
        session::HostSceneData data;
        for (std::size_t i = 0; i < reflectance.shape(0); ++i)
            data.reflectance.push_back(vec3(reflectance.data() + 3 * i));
        if (lamps.shape(0) != intensities.shape(0))
            throw std::invalid_argument("each lamp has a position and an intensity");
        for (std::size_t i = 0; i < lamps.shape(0); ++i)
            data.lamps.push_back({core::Vec3d(vec3(lamps.data() + 3 * i)), vec3(intensities.data() + 3 * i)});
        data.bounds = {vec3(bounds.first), vec3(bounds.second)};
        data.scattering = vec3(scattering), data.absorption = vec3(absorption);
        data.anisotropy = float(anisotropy);
        data.first_hit = [this](const session::HostSegment& s) { return hit(s); };
        if (!find_occluded_.is_none())
            data.find_occluded = [this](auto segments, auto hidden) { occlude(segments, hidden); };
        session::HostLightSettings settings;
        settings.method = session::host_method(method), settings.selection = selection;
        settings.paths = paths, settings.bound = float(bound);
        settings.compensation_steps = compensation_steps, settings.neighbours = neighbours;
        settings.seed = seed;
        const nb::gil_scoped_release released;
        scene_.emplace(std::move(data));
        light_.emplace(*scene_, settings);
    }

    std::size_t size() const { return light_->size(); }
    nb::object reflected(const Vectors& position, const Vectors& normal, const Materials& material) const {
        const std::size_t count = position.shape(0);
        if (normal.shape(0) != count || material.shape(0) != count)
            throw std::invalid_argument("each receiver has a position, a normal and a material");
        std::vector<float> values;
        {
            const nb::gil_scoped_release released;
            std::vector<session::HostReceiver> receivers;
            for (std::size_t i = 0; i < count; ++i)
                receivers.push_back(
                    {vec3(position.data() + 3 * i), vec3(normal.data() + 3 * i), material.data()[i]});
            for (const Rgb& l : light_->reflected(receivers)) values.insert(values.end(), {l.x, l.y, l.z});
        }
        return array_of(std::move(values), count, 3);
    }

  private:
    std::optional<session::HostHit> hit(const session::HostSegment& s) const {
        const nb::gil_scoped_acquire held;
        const Hit found = nb::cast<Hit>(first_hit_(triple(s.origin), triple(s.direction), double(s.length)));
        if (!found) return {};
        const auto& [distance, normal, material] = *found;
        return session::HostHit{float(distance), vec3(normal), material};
    }
    void occlude(std::span<const session::HostSegment> segments, std::span<std::uint8_t> hidden) const {
        const nb::gil_scoped_acquire held;
        std::vector<float> origins, directions, lengths;
        for (const session::HostSegment& s : segments) {
            origins.insert(origins.end(), {s.origin.x, s.origin.y, s.origin.z});
            directions.insert(directions.end(), {s.direction.x, s.direction.y, s.direction.z});
            lengths.push_back(s.length);
        }
        const std::size_t n = segments.size();
        const auto said = nb::cast<nb::ndarray<const bool, nb::ndim<1>, nb::c_contig, nb::device::cpu>>(
            find_occluded_(array_of(std::move(origins), n, 3), array_of(std::move(directions), n, 3),
                           array_of(std::move(lengths), n)));
        if (said.shape(0) != n)
            throw std::invalid_argument("find_occluded returns one bool for each segment");
        std::copy_n(said.data(), n, hidden.begin());
    }

    nb::callable first_hit_;
    nb::object find_occluded_;
    std::optional<session::HostScene> scene_;
    std::optional<session::HostLight> light_;
};

}  // namespace

void bind_host_light(nb::module_& m) {
    nb::class_<PythonHostLight>(m, "HostLight", "Indirect light over functions of a host.")
        .def(nb::init<nb::callable, nb::object, const Vectors&, const Vectors&, const Vectors&,
                      const std::pair<Triple, Triple>&, const Triple&, const Triple&, double,
                      const std::string&, const std::string&, std::uint32_t, double, int, std::uint32_t,
                      std::uint64_t>(),
             nb::arg("first_hit"), nb::arg("find_occluded").none(), nb::arg("reflectance"), nb::arg("lamps"),
             nb::arg("intensities"), nb::arg("bounds"), nb::arg("scattering"), nb::arg("absorption"),
             nb::arg("anisotropy"), nb::arg("method"), nb::arg("selection"), nb::arg("paths"),
             nb::arg("bound"), nb::arg("compensation_steps"), nb::arg("neighbours"), nb::arg("seed"))
        .def("__len__", &PythonHostLight::size)
        .def("reflected", &PythonHostLight::reflected);
}

}  // namespace mote::python
