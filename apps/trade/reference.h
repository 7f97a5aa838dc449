// The reference picture of a trade, and what it must be to judge others.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/image/image_file.h"
#include "core/scene/scene.h"

namespace mote::apps::trade {

/// A reference judges errors down to this many of its own standard errors.
inline constexpr double errors_to_judge = 10.0;

struct Reference {
    core::ImageChannels image;
    std::vector<core::Rgb> pixels;     ///< the beauty
    std::optional<double> error;       ///< its own standard error, as relative_standard_error() defines it
    std::optional<double> mean_error;  ///< of its mean brightness, relative
    std::optional<std::uint64_t> seed;

    std::string metadata(const std::string& key) const;  ///< "" where there is none
    double floor() const { return error ? errors_to_judge * *error : 0.0; }
    double error_per_bias() const;  ///< see Judge in curves.h
};

struct ReferenceRules {
    double resolve = 0.01;       ///< the smallest error that must be judged
    bool trust = false;          ///< take what the file does not say about itself for granted
    bool other_version = false;  ///< accept a reference of another version of the scene
};

/// Reads the file and throws InputError with the reason when it cannot judge pictures of this scene.
/// `content`: scene_content() of the scene.
Reference load_reference(const std::string& path, const core::Scene& scene, const std::string& content,
                         const ReferenceRules& rules);

/// True when the file is there and load_reference() with these rules would accept it.
bool is_good_reference(const std::string& path, const core::Scene& scene, const std::string& content,
                       const ReferenceRules& rules);

}  // namespace mote::apps::trade
