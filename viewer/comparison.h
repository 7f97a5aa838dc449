// Methods that render side by side against a reference, and the page that they are saved as.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/metrics/relative_error.h"
#include "core/objects/error.h"
#include "viewer/live_render.h"

namespace mote::viewer {

/// An image that live ones are measured against; its own noise, where it is known, is subtracted.
class Reference {
  public:
    /// Throws InputError for values that are not finite.
    Reference(std::string name, const core::ImageChannels& image);

    const std::string& name() const { return name_; }
    const core::ImageChannels& image() const { return image_; }
    /// Throws std::invalid_argument for an image of another size.
    core::RelativeError error_of(const core::ImageChannels& image) const;
    bool fits(const core::ImageChannels& image) const {
        return image.width == image_.width && image.height == image_.height && !image.rgb("").empty();
    }

  private:
    std::string name_;
    core::ImageChannels image_;
    std::vector<core::Rgb> pixels_, variance_;
    core::RelativeWeights weights_;
};

/// Error of a render after some of its passes.
struct ErrorPoint {
    std::uint32_t passes;
    double seconds;
    core::RelativeError error;
};

struct ComparedMethod {
    std::string name, integrator;
    SharedPicture picture;             ///< the last one
    std::vector<ErrorPoint> points;    ///< in order of time
    std::vector<std::string> command;  ///< that renders it, without passes and file
};

struct Comparison {
    std::string scene;  ///< file
    const Reference& reference;
    std::vector<ComparedMethod> methods;
    int threads = 1;  ///< of each method
};

/// Writer of the page. The class itself has none.
class ComparisonPage {
  public:
    virtual ~ComparisonPage() = default;
    /// Name and content of each file. Throws InputError.
    virtual std::vector<std::pair<std::string, std::string>> files(const Comparison&) const {
        throw core::InputError("this program writes no pages: mote view does");
    }
};

}  // namespace mote::viewer
