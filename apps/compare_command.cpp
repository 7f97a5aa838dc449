// mote compare: a picture against its reference, every number with its definition.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/command.h"
#include "apps/difference_picture.h"
#include "apps/picture_file.h"
#include "apps/subcommands.h"
#include "core/formats/pictures/image_file.h"
#include "core/metrics/error_map.h"
#include "core/metrics/halves_error.h"
#include "core/metrics/metrics.h"
#include "core/metrics/reference_pair.h"
#include "core/objects/error.h"
#include "session/compare.h"
#include "session/denoise/denoised_layer.h"
#include "session/number_or_null.h"
#include "session/output_files.h"
#include "session/reference_metadata.h"
#include "session/render_report.h"

namespace mote::apps {

namespace {

using core::ImageMetrics, core::InputError, core::MetricDefinition;
using nlohmann::json;

const char* const non_finite_definition =
    "pixels with a NaN or an infinity in a channel; none is left out, values that depend on one are NaN";
const char* const mean_definition = "per channel R, G, B, and over all of them";

/// Objections of the metadata to the comparison. The hash covers the settings too, so it can differ for
/// something about the scene only where the integrator is the same.
std::vector<std::string> doubts(const PictureFile& image, const PictureFile& reference) {
    const auto differ = [&](const char* name, auto same) {
        const auto a = image.metadata.find(name), r = reference.metadata.find(name);
        return a != image.metadata.end() && r != reference.metadata.end() && !same(a->second, r->second);
    };
    const auto equal = [](const std::string& a, const std::string& b) { return a == b; };
    std::vector<std::string> list;
    if (differ("worldToCamera", same_camera)) list.push_back("the pictures come from different cameras");
    if (const auto seed = image.metadata.find("seed");
        seed != image.metadata.end() && reference.metadata.contains("seed") && !differ("seed", equal))
        list.push_back("the pictures have the same seed, so their noise may be the same in part (--seed)");
    if (differ("sceneHash", equal) && image.metadata.contains("integrator") && !differ("integrator", equal))
        list.push_back("the pictures come from different scenes or settings (sceneHash)");
    return list;
}

/// `a` is the picture in the file `path`, `r` the first reference.
void check_sizes(const core::Bitmap& a, const std::string& path, const core::Bitmap& r,
                 const CompareArguments& arguments) {
    if (a.width == r.width && a.height == r.height) return;
    throw InputError(fmt::format("has {} x {} pixels, the reference {} has {} x {}", a.width, a.height,
                                 core::printable(arguments.reference), r.width, r.height),
                     {path, 0});
}

/// The reference, or the mean of both, and the error against them.
struct References {
    PictureFile first;
    std::optional<PictureFile> second;
    core::PairMean mean;

    core::ReferencePair pair() const {
        return {first.bitmap.pixels, second->bitmap.pixels, first.variance, second->variance};
    }
    const std::vector<core::Rgb>& pixels() const { return second ? mean.picture : first.bitmap.pixels; }
};

References read_references(const CompareArguments& arguments, const std::string& layer) {
    References r{read_picture(arguments.reference, layer), {}, {}};
    if (arguments.second.empty()) return r;
    r.second = read_picture(arguments.second, layer);
    check_sizes(r.second->bitmap, arguments.second, r.first.bitmap, arguments);
    if (r.second->bitmap.pixels == r.first.bitmap.pixels)
        throw InputError("is the same picture as the first reference: two must differ in their seeds",
                         {arguments.second, 0});
    r.mean = core::mean_of(r.pair());
    return r;
}

ImageMetrics measured(const PictureFile& image, const References& references) {
    const int width = image.bitmap.width, height = image.bitmap.height;
    const MeasuredPicture picture{image.bitmap.pixels, image.variance};
    if (references.second) return measure(picture, references.pair(), references.mean, width, height);
    return measure(picture, {references.first.bitmap.pixels, references.first.variance}, width, height);
}

json mean_json(const std::array<double, 3>& rgb, double average) {
    return {{"rgb", {number_or_null(rgb[0]), number_or_null(rgb[1]), number_or_null(rgb[2])}},
            {"average", number_or_null(average)},
            {"definition", mean_definition}};
}

std::string percent(double value) {
    return std::isfinite(value) ? fmt::format("{:.3g} %", 100.0 * value) : "unknown";
}

/// The error, what of it is bias, and what of it the image's own noise explains.
std::string headline(const ImageMetrics& m) {
    std::string text = "error      " + percent(m.error);
    if (std::isfinite(m.error_standard_error)) text += " +- " + percent(m.error_standard_error);
    text += fmt::format(", bias {}{}", m.bias > 0.0 ? "+" : "", percent(m.bias));
    if (std::isfinite(m.bias_standard_error)) text += " +- " + percent(m.bias_standard_error);
    if (std::isfinite(m.noise)) text += ", noise of the image " + percent(m.noise);
    return text + "\n";
}

std::string stated_text(const std::optional<core::PictureError>& stated) {
    if (!stated) return "";
    return "           the image states " + percent(stated->low) + " to " + percent(stated->high) +
           " with 95 % confidence\n";
}

/// Where a file is to be written: the difference's name, or none.
std::string difference_file(const CompareArguments& a) {
    if (a.difference.empty()) {
        if (!a.output.empty()) throw UsageError("-o is for --difference");
        return "";
    }
    const std::string path =
        a.output.empty() ? std::filesystem::path(a.image).stem().string() + "_difference.png" : a.output;
    if (extension_of(path) != ".png")
        throw UsageError("the difference '" + core::printable(path) + "' does not end in .png");
    return path;
}

void print_json(const CompareArguments& arguments, const core::Bitmap& size, const ImageMetrics& m,
                const std::optional<core::PictureError>& stated, const std::vector<std::string>& warnings) {
    nlohmann::ordered_json j;
    j["mote"] = MOTE_VERSION;
    j["image"] = arguments.image;
    j["reference"] = arguments.reference;
    if (!arguments.second.empty()) j["second_reference"] = arguments.second;
    if (!arguments.layer.empty()) j["layer"] = arguments.layer;
    j["width"] = size.width;
    j["height"] = size.height;
    j["non_finite"] = {{"share", m.non_finite_fraction()},
                       {"image", m.non_finite_image},
                       {"reference", m.non_finite_reference},
                       {"either", m.non_finite_either},
                       {"definition", non_finite_definition}};
    j["mean_image"] = mean_json(m.mean_image, m.average_image);
    j["mean_reference"] = mean_json(m.mean_reference, m.average_reference);
    for (const MetricDefinition& d : core::metric_definitions())
        j["metrics"][d.name] = {{"value", number_or_null(m.*d.value)}, {"definition", d.definition}};
    if (stated)
        j["stated_error"] = {
            {"low", stated->low},
            {"high", stated->high},
            {"definition", "ends of the interval of 95 % confidence that the image states of its error"}};
    if (!arguments.map.empty())
        j["map"] = {{"file", arguments.map},
                    {"lowest", core::ErrorScale().lowest},
                    {"highest", core::ErrorScale().highest},
                    {"definition", core::error_map_definition}};
    if (!arguments.difference.empty()) j["difference"]["file"] = difference_file(arguments);
    j["warnings"] = warnings;
    std::fputs((j.dump(2, ' ', false, json::error_handler_t::replace) + "\n").c_str(), stdout);
}

std::string mean_text(const std::array<double, 3>& rgb, double average) {
    return fmt::format("{:.6g} {:.6g} {:.6g}, average {:.6g}", rgb[0], rgb[1], rgb[2], average);
}

void print_text(const CompareArguments& arguments, const core::Bitmap& size, const ImageMetrics& m,
                const std::optional<core::PictureError>& stated, const std::string& difference) {
    std::string text = fmt::format("image      {}\nreference  {}\n", core::printable(arguments.image, 400),
                                   core::printable(arguments.reference, 400));
    if (!arguments.second.empty())
        text += fmt::format("and        {}: errors and biases are free of the noise of both\n",
                            core::printable(arguments.second, 400));
    if (!arguments.layer.empty()) text += fmt::format("layer      {}\n", core::printable(arguments.layer));
    text +=
        fmt::format("pixels     {} x {}\n\n", size.width, size.height) + headline(m) + stated_text(stated);
    text += fmt::format("non-finite {:.3g} % of the pixels ({} in the image, {} in the reference): {}\n",
                        100.0 * m.non_finite_fraction(), m.non_finite_image, m.non_finite_reference,
                        non_finite_definition);
    text += fmt::format("mean       {} in the image,\n           {} in the reference: {}\n",
                        mean_text(m.mean_image, m.average_image),
                        mean_text(m.mean_reference, m.average_reference), mean_definition);
    text += "\nd is image - reference, r the reference.\n";
    for (const MetricDefinition& d : core::metric_definitions())
        text += fmt::format("  {:<20} {:<12.6g} {}\n", d.name, m.*d.value, d.definition);
    if (!arguments.map.empty())
        text +=
            fmt::format("\nmap        {}: from {:g} to {:g}, {}\n", core::printable(arguments.map, 400),
                        core::ErrorScale().lowest, core::ErrorScale().highest, core::error_map_definition);
    text += difference;
    std::fputs(text.c_str(), stdout);
}

}  // namespace

int compare_command(const CompareArguments& arguments) {
    if (!arguments.map.empty() && extension_of(arguments.map) != ".png")
        throw UsageError("the map '" + core::printable(arguments.map) + "' does not end in .png");
    const std::string difference_path = difference_file(arguments);
    const double factor = arguments.difference.empty() ? 1.0 : amplification(arguments.difference);
    check_outputs(std::vector<NamedFile>{{"the map", arguments.map},
                                         {"the difference", difference_path, !arguments.output.empty()}},
                  std::vector<NamedFile>{{"the picture", arguments.image},
                                         {"the reference", arguments.reference},
                                         {"the second reference", arguments.second}});
    const std::size_t colon = arguments.layer.find(':');
    const std::string layer = arguments.layer.substr(0, colon);
    const std::string reference_layer =
        colon == std::string::npos ? layer : arguments.layer.substr(colon + 1);
    const PictureFile image = read_picture(arguments.image, layer);
    const References references = read_references(arguments, reference_layer);
    const core::Bitmap& a = image.bitmap;
    core::Bitmap r = references.first.bitmap;
    check_sizes(a, arguments.image, r, arguments);
    r.pixels = references.pixels();
    std::vector<std::string> warnings = doubts(image, references.first);
    const auto add = [&](const std::string& text) {
        if (!text.empty() && std::find(warnings.begin(), warnings.end(), text) == warnings.end())
            warnings.push_back(text);
    };
    add(denoised_doubt(image.metadata, arguments.image, layer));
    add(denoised_doubt(references.first.metadata, arguments.reference, reference_layer));
    if (references.second) {
        for (const std::string& text : doubts(image, *references.second)) add(text);
        add(denoised_doubt(references.second->metadata, arguments.second, reference_layer));
    }
    for (const std::string& warning : warnings)
        std::fputs(("mote: warning: " + warning + "\n").c_str(), stderr);
    const ImageMetrics metrics = measured(image, references);
    const std::optional<core::PictureError> stated =
        layer.empty() ? stated_error(image.metadata) : std::nullopt;
    if (!arguments.map.empty())
        core::write_png(arguments.map, a.width, a.height,
                        core::error_map(a.pixels, r.pixels, a.width, a.height));
    std::string difference;
    if (!difference_path.empty())
        difference = fmt::format("\ndifference {}: {}\n", core::printable(difference_path, 400),
                                 write_difference(difference_path, a, r, factor));
    if (arguments.json)
        print_json(arguments, a, metrics, stated, warnings);
    else
        print_text(arguments, a, metrics, stated, difference);
    return exit_ok;
}

}  // namespace mote::apps
