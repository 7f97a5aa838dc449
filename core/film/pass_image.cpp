#include "core/film/pass_image.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace mote::core {

PassImage::PassImage(int width, int height, std::size_t layers) : width_(width), height_(height) {
    if (width < 1 || height < 1) throw std::invalid_argument("a picture needs at least one pixel");
    finished_.assign(std::size_t(width) * std::size_t(height), 0);
    planes_.assign(layers, std::vector<Rgb>(std::size_t(width) * std::size_t(height), Rgb(0.0f)));
}

void PassImage::clear() {
    finishes_late_ = false;
    std::fill(finished_.begin(), finished_.end(), std::uint8_t(0));
    std::fill(places_.begin(), places_.end(), nowhere);
    for (auto& plane : planes_) std::fill(plane.begin(), plane.end(), Rgb(0.0f));
}

void PassImage::keep_places() { places_.assign(finished_.size(), nowhere); }

void PassImage::place(int x, int y, const Vec2& film) {
    if (places_.empty()) return;
    const float column = std::floor(2.0f * film.x), row = std::floor(2.0f * film.y);
    const bool inside = column >= 0.0f && row >= 0.0f && column < float(2 * width_) &&
                        row < float(2 * height_) && std::fabs(film.y - (float(y) + 0.5f)) < float(max_reach);
    places_[std::size_t(y) * std::size_t(width_) + std::size_t(x)] =
        inside ? std::uint32_t(row) * std::uint32_t(2 * width_) + std::uint32_t(column) : nowhere;
}

}  // namespace mote::core
