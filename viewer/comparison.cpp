#include "viewer/comparison.h"

#include <algorithm>

#include "session/reference_metadata.h"

namespace mote::viewer {

Reference::Reference(std::string name, const core::ImageChannels& image)
    : name_(std::move(name)),
      image_(image),
      pixels_(image.rgb("")),
      variance_(session::variance_of_beauty(image)) {
    if (pixels_.empty() ||
        !std::ranges::all_of(pixels_, [](const core::Rgb& c) { return core::is_finite(c); }))
        throw core::InputError("a reference has finite R, G and B", {name_, 0});
    weights_ = core::relative_weights(pixels_, variance_, image.width, image.height);
}

core::RelativeError Reference::error_of(const core::ImageChannels& image) const {
    return core::relative_error(image.rgb(""), pixels_, weights_, {}, variance_);
}

}  // namespace mote::viewer
