// A constant as a volume, and as the extinction of a tracked medium: one unbounded cell whose bounds are the
// value itself, so that every tentative collision is real and transmittance is analytic.
#include "media/constant_volume.h"

#include "core/objects/properties.h"
#include "core/objects/registry.h"
#include "media/medium_parameters.h"
#include "media/tracked_medium.h"

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

ConstantVolume::ConstantVolume(const Rgb& value) : value_(value) {
    if (!core::is_finite(value) || core::min_component(value) < 0.0f)
        throw core::InputError("a constant volume must be finite and not negative");
}

std::shared_ptr<HeterogeneousMedium> ConstantVolume::make_medium(MediumParts parts) const {
    const bool grey = value_.x == value_.y && value_.y == value_.z;
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
         {{"value", "rgb", "1", "The value, not negative."}},
         R"(<volume type="constvolume"><rgb name="value" value="0.9 0.8 0.7"/></volume>)"},
        [](const core::Properties& p) {
            return std::make_shared<ConstantVolume>(p.get_rgb_in("value", Rgb(1.0f), 0.0f, unlimited));
        });
}

}  // namespace mote::media
