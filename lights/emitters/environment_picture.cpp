#include "lights/emitters/environment_picture.h"

#include <fmt/format.h>

#include <algorithm>

#include "lights/emitters/light_values.h"

namespace mote::lights {

using namespace core;

namespace {

constexpr double pi_d = 3.14159265358979323846;

/// int (1-t) sin(theta) dt and int t sin(theta) dt over t in [0,1], theta = a + t d: how much of a row of
/// cells belongs to its upper and its lower pixels.
struct HatWeights {
    double upper, lower;
};
HatWeights hat_weights(double a, double d) {
    const double whole = (std::cos(a) - std::cos(a + d)) / d;
    const double lower = (std::sin(a + d) - std::sin(a)) / (d * d) - std::cos(a + d) / d;
    // Differences of nearly equal numbers at the poles of large pictures: never below zero.
    return {std::max(whole - lower, 0.0), std::max(lower, 0.0)};
}

}  // namespace

EnvironmentPicture::EnvironmentPicture(Bitmap picture)
    : picture_(std::move(picture)), columns_(picture_.width), rows_(std::max(picture_.height - 1, 1)) {
    const double row_angle = pi_d / double(rows_);
    for (int row = 0; row <= rows_; ++row) cosines_.push_back(float(std::cos(double(row) * row_angle)));

    std::vector<float> table(std::size_t(columns_) * std::size_t(rows_));
    glm::dvec3 sum(0.0);
    const double cell_area = row_angle * 2.0 * pi_d / double(columns_);
    for (int row = 0; row < rows_; ++row) {
        const HatWeights w = hat_weights(double(row) * row_angle, row_angle);
        for (int column = 0; column < columns_; ++column) {
            const auto upper = glm::dvec3(pixel(column, row)) + glm::dvec3(pixel(column + 1, row));
            const auto lower = glm::dvec3(pixel(column, row + 1)) + glm::dvec3(pixel(column + 1, row + 1));
            const glm::dvec3 power = 0.5 * cell_area * (w.upper * upper + w.lower * lower);
            sum += power;
            table[std::size_t(row) * std::size_t(columns_) + std::size_t(column)] = luminance(Rgb(power));
        }
    }
    distribution_ = Distribution2D(table, std::size_t(columns_), std::size_t(rows_));
    integral_ = Rgb(sum);
}

const Rgb& EnvironmentPicture::pixel(int column, int row) const {
    const int x = column >= columns_ ? column - columns_ : column;
    const int y = std::min(row, picture_.height - 1);
    return picture_.pixels[std::size_t(y) * std::size_t(columns_) + std::size_t(x)];
}

Vec2 EnvironmentPicture::cell_coordinates(const Vec3& d) const {
    const float u = std::atan2(d.x, -d.z) * inv_two_pi;
    // acos(y) would lose half the digits near the poles.
    const float v = std::atan2(std::hypot(d.x, d.z), d.y) * inv_pi;
    float x = u * float(columns_) - 0.5f;
    if (x < 0.0f) x += float(columns_);
    return {std::clamp(x, 0.0f, float(columns_) * one_minus_epsilon),
            std::clamp(v * float(rows_), 0.0f, float(rows_) * one_minus_epsilon)};
}

Rgb EnvironmentPicture::eval(const Vec3& d) const {
    const Vec2 at = cell_coordinates(d);
    const int column = int(at.x), row = int(at.y);
    const float s = at.x - float(column), t = at.y - float(row);
    return (1.0f - t) * ((1.0f - s) * pixel(column, row) + s * pixel(column + 1, row)) +
           t * ((1.0f - s) * pixel(column, row + 1) + s * pixel(column + 1, row + 1));
}

float EnvironmentPicture::cell_solid_angle(int row) const {
    return 2.0f * pi / float(columns_) * (cosines_[std::size_t(row)] - cosines_[std::size_t(row) + 1]);
}

EnvironmentPicture::Sample EnvironmentPicture::sample(const Vec2& u) const {
    const auto s = distribution_.sample(u);
    const float y = s.uv.y * float(rows_);
    const int row = std::min(int(y), rows_ - 1);
    // Even in cos(theta) within a row: the density per solid angle is then constant in a cell, poles
    // included.
    const float cos_theta = lerp(cosines_[std::size_t(row)], cosines_[std::size_t(row) + 1], y - float(row));
    const float sin_theta = safe_sqrt((1.0f - cos_theta) * (1.0f + cos_theta));
    const float phi = 2.0f * pi * (s.uv.x + 0.5f / float(columns_));
    const Vec3 direction(std::sin(phi) * sin_theta, cos_theta, -std::cos(phi) * sin_theta);
    return {direction, s.pdf / (float(columns_) * float(rows_) * cell_solid_angle(row))};
}

float EnvironmentPicture::pdf_solid_angle(const Vec3& d) const {
    if (black()) return 0.0f;
    const Vec2 at = cell_coordinates(d);
    const Vec2 center(std::floor(at.x) + 0.5f, std::floor(at.y) + 0.5f);
    const Vec2 cells = Vec2(float(columns_), float(rows_));
    return distribution_.pdf(center / cells) / (cells.x * cells.y * cell_solid_angle(int(at.y)));
}

void check_pixels(const Bitmap& picture, const std::string& name, const SourceLocation& where) {
    if (picture.width <= 0 || picture.height <= 0 ||
        picture.pixels.size() != std::size_t(picture.width) * std::size_t(picture.height))
        throw InputError(fmt::format("environment map '{}' has no pixels", name), where);
    std::size_t bad = 0, first = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const Rgb& c = picture.pixels[i];
        if (is_finite(c) && min_component(c) >= 0.0f && max_component(c) <= brightest) continue;
        if (bad++ == 0) first = i;
    }
    if (bad == 0) return;
    const Rgb& c = picture.pixels[first];
    const auto width = std::size_t(picture.width);
    throw InputError(fmt::format("environment map '{}' has {} pixel{} that {} negative, not finite or above "
                                 "{:g}; the first is x = {}, y = {} ({} {} {})",
                                 name, bad, bad == 1 ? "" : "s", bad == 1 ? "is" : "are", brightest,
                                 first % width, first / width, c.x, c.y, c.z),
                     where);
}

}  // namespace mote::lights
