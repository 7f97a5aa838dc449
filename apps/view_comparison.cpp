#include "apps/view_comparison.h"

#include <fmt/format.h>

#include <cmath>

#include "core/formats/conversion/scratch_folder.h"
#include "core/formats/pictures/image_file.h"
#include "session/output_files.h"
#include "session/reference_metadata.h"
#include "session/render_report.h"
#include "trade/draw.h"
#include "trade/folder.h"
#include "trade/reference.h"

namespace mote::apps {

namespace {

using nlohmann::json;
using viewer::ComparedMethod, viewer::Comparison, viewer::ErrorPoint;

constexpr int page_width = 640;

std::string name_of(const ComparedMethod& m) { return m.name + ": " + m.integrator; }

trade::Method method_of(const ComparedMethod& m) {
    trade::Method method;
    method.name = name_of(m), method.slug = trade::slug_of(method.name), method.type = m.integrator;
    for (const auto& [path, value] : m.picture->wish.changes.defines)
        if (path.starts_with("integrator.")) method.settings[path.substr(path.find('.') + 1)] = value;
    return method;
}

json reference_json(const viewer::Reference& reference) {
    const core::ImageChannels& image = reference.image();
    trade::Reference r{image, image.rgb(""), session::variance_of_beauty(image), {}, {}, 0.0, {}};
    json facts = {{"file", reference.name()}};
    if (!r.variance.empty()) {
        r.weights = core::relative_weights(r.pixels, r.variance, image.width, image.height);
        const core::RelativeError own = core::relative_error(r.pixels, r.pixels, r.weights, r.variance);
        r.noise = own.noise, facts["noise"] = own.noise, facts["bias_error"] = own.bias_standard_error;
    }
    facts["floor"] = r.floor();
    for (const auto& [fact, key] : {std::pair{"integrator", "integrator"},
                                    {"passes", "passes"},
                                    {"seconds", "seconds"},
                                    {"command", "commandLine"}})
        facts[fact] = r.metadata(key);
    return facts;
}

trade::Identity identity_of(const Comparison& c, const std::vector<trade::Method>& methods) {
    trade::Identity identity;
    const core::ImageChannels& image = c.reference.image();
    json list = json::array();
    for (std::size_t i = 0; i < methods.size(); ++i) {
        std::vector<std::string> command = c.methods[i].command;
        command.insert(command.end(), {"-o", methods[i].slug + ".exr"});
        list.push_back({{"name", methods[i].name},
                        {"slug", methods[i].slug},
                        {"integrator", methods[i].type},
                        {"settings", methods[i].settings},
                        {"command", command}});
    }
    identity.inputs = {{"mote", MOTE_VERSION}};
    identity.facts = {
        {"scene", c.scene},
        {"width", image.width},
        {"height", image.height},
        {"threads", c.threads},
        {"seeds", json::array({c.methods.front().picture->wish.seed})},
        {"turns", "The methods rendered beside each other in a viewer, each on threads of its own."},
        {"git_hash", session::git_hash()},
        {"command", session::quoted({"mote", "view", c.scene, "--reference", c.reference.name()})},
        {"methods", list},
        {"reference", reference_json(c.reference)}};
    return identity;
}

trade::Record record_of(const ComparedMethod& m, const trade::Method& method, const ErrorPoint& p,
                        double floor) {
    trade::Record r;
    r.method = method.name, r.integrator = method.type, r.settings = method.settings_text();
    r.seed = m.picture->wish.seed, r.passes = p.passes, r.wall = p.seconds;
    r.cpu = r.build = r.peak_memory_mb = trade::unknown;  // of one of several methods at once
    r.error = p.error.error, r.bias = p.error.bias;
    if (floor > 0.0) r.error_se = p.error.error_standard_error;
    r.below_reference = r.error < floor;
    return r;
}

/// The beauty alone: files that are read have attributes of other programs.
core::ImageChannels beauty_of(const core::ImageChannels& image) {
    core::ImageChannels beauty;
    beauty.width = image.width, beauty.height = image.height;
    beauty.add_rgb("", image.rgb(""));
    return beauty;
}

/// Points whose times differ by a tenth, and the last one.
std::vector<ErrorPoint> thinned(const std::vector<ErrorPoint>& points) {
    std::vector<ErrorPoint> kept;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (kept.empty() || i + 1 == points.size() || points[i].seconds >= 1.1 * kept.back().seconds)
            kept.push_back(points[i]);
    return kept;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> TradePage::files(const Comparison& comparison) const {
    const core::ScratchFolder scratch;
    std::vector<trade::Method> methods;
    for (const ComparedMethod& m : comparison.methods) methods.push_back(method_of(m));
    trade::Folder folder(scratch.path(), methods, true);
    const trade::Identity identity = identity_of(comparison, methods);
    folder.open(identity);
    const double floor = identity.facts.at("reference").at("floor").get<double>();
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const ComparedMethod& m = comparison.methods[i];
        const std::vector<ErrorPoint> points = thinned(m.points);
        for (const ErrorPoint& p : points) {
            trade::Record record = record_of(m, methods[i], p, floor);
            record.final = m.picture->finished && &p == &points.back();
            folder.add(record);
        }
        core::write_exr(folder.file(methods[i].slug + ".exr"), beauty_of(m.picture->image));
    }
    core::write_exr(folder.file("reference.exr"), beauty_of(comparison.reference.image()));
    trade::draw(folder, page_width);
    return {{"trade.html", folder.read("trade.html")}, {"trade.csv", folder.read("trade.csv")}};
}

}  // namespace mote::apps
