// A constant as a volume, and as the extinction of a tracked medium: one unbounded cell whose bounds are the
// value itself, so that every tentative collision is real and transmittance is analytic.
#include "media/constant_volume.h"

#include "media/grid_volume.h"
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

VolumePtr make_constant_volume(float value) { return std::make_shared<ConstantVolume>(Rgb(value)); }

void register_constant_volume(core::Registry& registry) {
    using namespace core;
    struct Settings {
        Rgb value{1.0f};
        std::optional<Transform> to_world;
    };
    add_type<Settings>(
        registry, Category::volume, "constvolume", "The same value everywhere.",
        {row("value", &Settings::value, at_least(0), "The value."),
         row("to_world", &Settings::to_world,
             "As an extinction it ends at the transformed unit cube (at the smallest box along the world's "
             "axes around it), as in Mitsuba 3; without one it extends to the shapes that hold the medium.")
             .when_absent("none")},
        R"(<volume type="constvolume"><rgb name="value" value="0.9 0.8 0.7"/></volume>)",
        [](const Settings& s) { return std::make_shared<ConstantVolume>(s.value, s.to_world); });
}

namespace {

class VolumeKind final : public core::ValueKind {
    std::string type(const core::Row&) const override { return "volume"; }
    void read(const core::Properties& p, const core::Row& row, void* member) const override {
        auto& volume = *static_cast<VolumePtr*>(member);
        volume = p.child<Volume>(row.parameter.name);
        if (!volume) volume = std::make_shared<ConstantVolume>(core::read_rgb(p, row));
    }
    std::string text(const core::Row&, const void* member) const override {
        const auto& volume = *static_cast<const VolumePtr*>(member);
        return volume ? core::rgb_text(volume->upper_bound()) : "none";
    }
};

}  // namespace

const core::ValueKind& kind_of(core::Type<VolumePtr>) {
    static const VolumeKind kind;
    return kind;
}

}  // namespace mote::media
