#include "core/film/pass_image.h"

#include <algorithm>
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
    for (auto& plane : planes_) std::fill(plane.begin(), plane.end(), Rgb(0.0f));
}

}  // namespace mote::core
