// Every check of a reference; session/reference_metadata.h says what `mote` writes into its pictures for
// them.
#include "trade/reference.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "core/formats/pictures/image_file.h"
#include "core/metrics/metrics.h"
#include "core/objects/error.h"
#include "session/reference_metadata.h"

namespace mote::trade {

using namespace session;

namespace {

using core::InputError;

std::optional<double> number(const std::string& text) {
    char* end = nullptr;
    const double v = std::strtod(text.c_str(), &end);
    return text.empty() || *end != '\0' || !(v >= 0.0) ? std::nullopt : std::optional(v);
}

/// Weights and noise, which need pixels that are finite.
void set_weights(Reference& r) {
    r.weights = core::relative_weights(r.pixels, r.variance, r.image.width, r.image.height);
    if (r.variance.empty()) return;
    // Against itself: no error, but the noise that it says it has.
    const core::RelativeError own = core::relative_error(r.pixels, r.pixels, r.weights, r.variance);
    r.noise = own.noise, r.bias_error = own.bias_standard_error;
}

class Check {
  public:
    Check(const std::string& path, Reference& reference, const core::Scene& scene,
          const ReferenceRules& rules)
        : path_(path), reference_(reference), scene_(scene), rules_(rules) {}

    void run(const std::string& content) const {
        check_size();
        check_pixels();
        set_weights(reference_);
        check_camera();
        check_scene(content);
        check_completeness();
        check_noise();
    }

  private:
    [[noreturn]] void refuse(const std::string& reason) const {
        throw InputError("cannot be the reference: " + reason, {path_, 0});
    }
    void check_size() const {
        const core::FilmSettings& film = scene_.film();
        if (reference_.image.width != film.width || reference_.image.height != film.height)
            refuse(fmt::format("it has {} x {} pixels, the scene's film {} x {}", reference_.image.width,
                               reference_.image.height, film.width, film.height));
    }
    void check_pixels() const {
        if (reference_.pixels.empty()) refuse("it has no channels R, G and B");
        const auto m = core::compare_images(reference_.pixels, reference_.pixels, scene_.film().width,
                                            scene_.film().height);
        if (m.non_finite_either > 0)
            refuse(fmt::format("{} of its {} pixels are NaN or infinite", m.non_finite_either, m.pixels));
        if (!(m.average_reference > 0.0)) refuse("it is black");
    }
    void check_camera() const {
        const std::string text = reference_.metadata("worldToCamera");
        if (text.empty()) {
            if (rules_.trust) return;
            refuse(
                "it does not say by which camera it was made (no worldToCamera); --trust-reference takes it "
                "for the right one");
        }
        if (!same_camera(text, world_to_camera(scene_.camera())))
            refuse(
                "it was made with another camera: its coordinates (worldToCamera) are not those of the "
                "scene");
    }
    void check_scene(const std::string& content) const {
        const std::string theirs = reference_.metadata("sceneContent");
        if (theirs.empty()) {
            if (rules_.trust) return;
            refuse(
                "it does not say of which scene it is (no sceneContent): render it with 'mote trade "
                "--make-reference', or take it for the right one with --trust-reference");
        }
        if (theirs == content || rules_.other_version) return;
        refuse(
            "it was made from another scene, another version of it or with other -D definitions; "
            "--force-reference uses it all the same");
    }
    void check_completeness() const {
        const std::string left_out = reference_.metadata("leavesOut");
        if (!left_out.empty() && !rules_.trust)
            refuse("it was rendered by " + core::printable(reference_.metadata("integrator")) +
                   ", which leaves out: " + core::printable(left_out) +
                   "; --trust-reference uses it all the same");
    }
    void check_noise() const {
        if (!reference_.noise) {
            if (rules_.trust) return;
            refuse(
                "how noisy it is, is not known (it has no layer 'Variance'): render one with 'mote trade "
                "--make-reference', or take it for exact with --trust-reference");
        }
        if (reference_.floor() <= rules_.resolve * (1.0 + 1e-6)) return;
        refuse(
            fmt::format("it is too noisy: with a noise of {:.3g} % it judges errors down to {:.3g} %, not "
                        "{:.3g} %; continue it with --make-reference, or demand less by --resolve {:.3g}",
                        100.0 * *reference_.noise, 100.0 * reference_.floor(), 100.0 * rules_.resolve,
                        reference_.floor() * 1.01));
    }

    const std::string& path_;
    Reference& reference_;
    const core::Scene& scene_;
    const ReferenceRules& rules_;
};

}  // namespace

std::string Reference::metadata(const std::string& key) const {
    const auto it = image.metadata.find(key);
    return it == image.metadata.end() ? "" : it->second;
}

double smallest_error(std::span<const core::Rgb> variance, const core::RelativeWeights& weights) {
    double squares = 0.0;
    for (std::size_t p = 0; p < variance.size(); ++p) {
        const double v = weights.weight[p] * core::mean_of_channels(variance[p]);
        squares += 2.0 * v * v;
    }
    return weights.norm > 0.0 ? std::sqrt(2.0 * std::sqrt(squares) / weights.norm) : core::infinity;
}

double smallest_error(const core::Film& film) {
    if (film.pass_count() < 2) return core::infinity;
    const std::vector<core::Rgb> picture = film.beauty();
    std::vector<core::Rgb> variance = film.beauty_variance_of_mean();
    const auto gain = float(film.gain_and_noise().gain);
    for (core::Rgb& v : variance) v *= gain;
    return smallest_error(variance, core::relative_weights(picture, variance, film.width(), film.height()));
}

Reference load_reference(const std::string& path, const core::Scene& scene, const std::string& content,
                         const ReferenceRules& rules) {
    Reference reference;
    reference.image = core::read_exr(path);
    reference.pixels = reference.image.rgb("");
    reference.variance = variance_of_beauty(reference.image);
    if (const auto seed = number(reference.metadata("seed"))) reference.seed = std::uint64_t(*seed);
    Check(path, reference, scene, rules).run(content);
    return reference;
}

bool is_good_reference(const std::string& path, const core::Scene& scene, const std::string& content,
                       const ReferenceRules& rules) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) return false;
    try {
        load_reference(path, scene, content, rules);
        return true;
    } catch (const InputError&) {
        return false;
    }
}

}  // namespace mote::trade
