#include "session/placement_notes.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/scene/medium.h"
#include "core/scene/scene.h"

namespace mote::session {

namespace {

using core::Bounds3;

constexpr double little = 0.5;

double volume(const Bounds3& b) {
    if (b.empty()) return 0.0;
    const core::Vec3d d(b.diagonal());
    return d.x * d.y * d.z;
}

std::string text_of(const Bounds3& b) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g})", b.lower.x, b.lower.y,
                       b.lower.z, b.upper.x, b.upper.y, b.upper.z);
}

/// The box of the shapes that have the medium inside.
Bounds3 holders_of(const core::Medium& medium, const core::Scene& scene) {
    Bounds3 box;
    for (const auto& shape : scene.shapes())
        if (shape->interior.get() == &medium) box.extend(shape->bounds());
    return box;
}

std::string name_of(const core::Medium& medium) {
    return medium.id.empty() ? "a medium" : "medium '" + core::printable(medium.id) + "'";
}

void note_overlap(const core::Medium& medium, const core::Scene& scene, std::vector<std::string>& notes) {
    const Bounds3 grid = medium.bounds(), holder = holders_of(medium, scene);
    const bool whole = core::is_finite(core::Rgb(grid.lower)) && core::is_finite(core::Rgb(grid.upper)) &&
                       core::is_finite(core::Rgb(holder.lower)) && core::is_finite(core::Rgb(holder.upper));
    const double of_grid = volume(grid), of_holder = volume(holder);
    if (!whole || !(of_grid > 0.0) || !(of_holder > 0.0)) return;
    const double both = volume({glm::max(grid.lower, holder.lower), glm::min(grid.upper, holder.upper)});
    if (both >= little * std::min(of_grid, of_holder)) return;
    notes.push_back(
        fmt::format("{}: its grid, {}, and the shapes that hold it, {}, overlap little: {:.2g} % of "
                    "the grid's box is in the shapes' box",
                    name_of(medium), text_of(grid), text_of(holder), 100.0 * both / of_grid));
}

/// Single precision has seven digits: what the distance from the origin takes of them is lost to shapes.
void note_distance(const core::Scene& scene, std::vector<std::string>& notes) {
    constexpr double far_away = 1000.0;  ///< times the scene's size: a digit is left below shadow_fraction()
    const Bounds3 box = scene.bounds();
    const double reach = core::max_component(glm::max(-box.lower, box.upper));
    const double size = core::max_component(box.diagonal());
    if (!(size > 0.0) || !(reach > far_away * size)) return;
    notes.push_back(
        fmt::format("the scene, {:.3g} m wide, lies {:.3g} m from the origin of its coordinates, which are "
                    "rounded to {:.2g} m there: light may be lost or leak; move it to the origin",
                    size, reach, reach * 0x1p-24));
}

}  // namespace

std::vector<std::string> placement_notes(const core::Scene& scene) {
    std::vector<std::string> notes;
    note_distance(scene, notes);
    for (const auto& medium : scene.media()) note_overlap(*medium, scene, notes);
    const core::Medium* around = scene.camera_medium_state().current();
    if (around && !scene.camera().medium)
        notes.push_back("the camera stands in " + name_of(*around) +
                        ", which its sensor does not name: Mitsuba would see none there");
    return notes;
}

}  // namespace mote::session
