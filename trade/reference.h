// The reference picture of a trade, and what it must be to judge others.
//
// Its own noise, known pixel by pixel, is subtracted from every error; how exactly that can be done is what
// limits it: an error of 1 % is still seen by a reference with a noise of 4 %.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/film/film.h"
#include "core/film/image_channels.h"
#include "core/metrics/relative_error.h"
#include "core/scene/scene.h"

namespace mote::trade {

/// The smallest error that a picture with this variance distinguishes from none: the root of two standard
/// errors of the square of an error that is zero. `weights` are its own. Infinity where it is black.
double smallest_error(std::span<const core::Rgb> variance, const core::RelativeWeights& weights);
/// Smallest error that the film of a reference judges. Infinity for fewer than two passes.
double smallest_error(const core::Film& film);

struct Reference {
    core::ImageChannels image;
    std::vector<core::Rgb> pixels;    ///< the beauty
    std::vector<core::Rgb> variance;  ///< of its mean, pixel by pixel; empty where it does not say
    core::RelativeWeights weights;    ///< of relative_error.h
    std::optional<double> noise;      ///< its own, where the variance is known
    double bias_error = 0.0;          ///< standard error that its noise adds to every bias
    std::optional<std::uint64_t> seed;

    std::string metadata(const std::string& key) const;  ///< "" where there is none
    /// The smallest error that it judges; 0 where its noise is not known.
    double floor() const { return noise ? smallest_error(variance, weights) : 0.0; }
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

}  // namespace mote::trade
