// A constant as a volume, and as the extinction of a tracked medium: one unbounded cell whose bounds are the
// value itself, so that every tentative collision is real and transmittance is analytic.
#include "media/constant_volume.h"

#include "core/objects/properties.h"
#include "core/objects/registry.h"
#include "media/grid_volume.h"
#include "media/medium_parameters.h"
#include "media/tracked_medium.h"
#include "media/vol_file.h"

namespace mote::media {

using core::Rgb;

namespace {

template <typename V>
struct ConstantGrid {
    using Value = V;
    struct Cursor {
        Value value;
        Value lookup(const core::Vec3d&) const { return value; }
    };
    Cursor cursor() const { return {value}; }

    Value value;
    core::Transform world_to_index{};
    MajorantGrid<Value> majorants;
    std::string description = "constvolume";
};

template <typename V>
std::shared_ptr<HeterogeneousMedium> tracked(const V& value, MediumParts parts) {
    ConstantGrid<V> grid{value, {}, MajorantGrid<V>({value, value})};
    return std::make_shared<TrackedMedium<ConstantGrid<V>>>(std::move(grid), std::move(parts));
}

}  // namespace

ConstantVolume::ConstantVolume(const Rgb& value, std::optional<core::Transform> to_world)
    : value_(value), to_world_(std::move(to_world)) {
    if (!core::is_finite(value) || core::min_component(value) < 0.0f)
        throw core::InputError("a constant volume must be finite and not negative");
}

std::shared_ptr<HeterogeneousMedium> ConstantVolume::make_medium(MediumParts parts) const {
    const bool grey = value_.x == value_.y && value_.y == value_.z;
    if (to_world_) {  // a grid of one voxel ends at its box
        VolFile voxel;
        voxel.resolution = {1, 1, 1}, voxel.channels = grey ? 1 : 3;
        voxel.values = {value_.x, value_.y, value_.z};
        voxel.values.resize(std::size_t(voxel.channels));
        return GridVolume(std::move(voxel), *to_world_, false, "constvolume").make_medium(std::move(parts));
    }
    return grey ? tracked(value_.x, std::move(parts)) : tracked(value_, std::move(parts));
}

std::shared_ptr<const Volume> volume_of(const core::Properties& p, const std::string& name,
                                        const Rgb& default_value) {
    if (auto nested = p.child<Volume>(name)) return nested;
    return std::make_shared<ConstantVolume>(p.get_rgb_in(name, default_value, 0.0f, unlimited));
}

void register_constant_volume(core::Registry& registry) {
    registry.add(
        {core::Category::volume,
         "constvolume",
         "The same value everywhere.",
         {{"value", "rgb", "1", "The value, not negative."},
          {"to_world", "transform", "none",
           "As an extinction it ends at the transformed unit cube (at the smallest box along the world's "
           "axes "
           "around it), as in Mitsuba 3; without one it goes on to the shapes that hold the medium."}},
         R"(<volume type="constvolume"><rgb name="value" value="0.9 0.8 0.7"/></volume>)"},
        [](const core::Properties& p) {
            std::optional<core::Transform> to_world;
            if (p.has("to_world")) to_world = p.get_transform();
            return std::make_shared<ConstantVolume>(p.get_rgb_in("value", Rgb(1.0f), 0.0f, unlimited),
                                                    to_world);
        });
}

}  // namespace mote::media
