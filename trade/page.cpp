// trade.html: plot, table, flip book, definitions, commands.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/formats/pictures/image_file.h"
#include "core/objects/error.h"
#include "session/render_report.h"
#include "trade/draw.h"
#include "trade/methods_file.h"
#include "trade/packed_picture.h"

#include "trade_page_text.h"  // page.css and page.js, of the build

namespace mote::trade {

using namespace session;

namespace {

using nlohmann::json;

std::string cell(const std::string& html, const char* css = "") {
    return *css ? fmt::format("<td class=\"{}\">{}</td>", css, html) : "<td>" + html + "</td>";
}

std::string rounded_text(double v, const char* unit = "") {
    return std::isfinite(v) ? fmt::format("{:.3g}{}", v, unit) : "unknown";
}

std::string seconds_cell(double v) { return cell(v < 0.01 ? "&lt; 0.01" : rounded_text(v)); }

std::string bias_cell(const Results& results, const Curve& c) {
    if (!std::isfinite(c.bias)) return cell("unknown");
    const std::string text =
        fmt::format("{:+.2f} &plusmn; {} %", 100.0 * c.bias,
                    std::isfinite(c.bias_se) ? fmt::format("{:.2f}", 100.0 * c.bias_se) : std::string("?"));
    return bias_is_significant(c, results.judge.bias_error) ? cell(text, "biased") : cell(text);
}

std::string error_cell(const Curve& c) {
    if (c.points.empty()) return cell("unknown");
    const CurvePoint& p = c.points.back();
    std::string text = fmt::format("{:.3g} %", 100.0 * p.error);
    if (std::isfinite(p.error_se))
        text = fmt::format("{:.3g} &plusmn; {:.1g} %", 100.0 * p.error, 100.0 * p.error_se);
    if (c.seeds > 1) text += fmt::format("<br>{:.3g} to {:.3g}", 100.0 * p.lowest, 100.0 * p.highest);
    return p.below_reference ? cell(text + "<br>below the reference", "guess") : cell(text);
}

std::string row(const Results& results, std::size_t index) {
    const Curve& c = results.curves[index];
    std::string html = fmt::format("<tr><td><span class=\"swatch\" style=\"background:{}\"></span>{}</td>",
                                   curve_colours(results.curves)[index], escaped(c.method));
    html += cell(escaped(c.integrator + (c.settings.empty() ? "" : ": " + c.settings)), "text wrap");
    html += cell(rounded_text(c.passes)) + seconds_cell(c.wall) + seconds_cell(c.cpu) +
            seconds_cell(c.build) + error_cell(c) + bias_cell(results, c);
    for (const Reach& r : results.reaches(c))
        html += cell(escaped(to_text(r, c)), r.kind == Reach::Kind::measured ? "wrap" : "wrap guess");
    const std::string front = results.front_text(c);
    html += cell(front.empty() ? "no" : front, "wrap") + cell(rounded_text(c.inefficiency())) +
            cell(rounded_text(c.relmse)) + cell(rounded_text(c.relmse_trimmed)) +
            cell(rounded_text(c.peak_memory_mb)) + cell(fmt::format("{}", c.non_finite));
    return html + "</tr>\n";
}

std::string table(const Results& results) {
    std::string html =
        "<div class=\"scroll\"><table>\n<tr><th>method</th><th class=\"text\">settings</th><th>passes</th>"
        "<th>wall s</th><th>CPU s</th><th>of it<br>build s</th><th>error<br>(range)</th><th>bias &plusmn; "
        "standard<br>error</th>";
    for (const double e : errors_of_interest) html += fmt::format("<th>time to<br>{:g} %</th>", 100.0 * e);
    html +=
        "<th>on the<br>front</th><th>error&sup2;<br>&times; "
        "seconds</th><th>relMSE</th><th>trimmed<br>relMSE</th>"
        "<th>peak MB</th><th>non-<br>finite</th></tr>\n";
    for (std::size_t i = 0; i < results.curves.size(); ++i) html += row(results, i);
    return html + "</table></div>\n";
}

/// JSON that can stand inside <script>.
std::string script_json(const json& value) {
    std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
    for (std::size_t at = 0; (at = text.find("</", at)) != std::string::npos; at += 3)
        text.insert(at + 1, "\\");
    return text;
}

// So that the brightest tenth of the reference is about white.
double exposure_for(const Picture& reference) {
    std::vector<float> values;
    for (const core::Rgb& c : reference.pixels) values.push_back(std::max({c.x, c.y, c.z}));
    const auto at = values.begin() + std::ptrdiff_t(values.size() * 9 / 10);
    std::nth_element(values.begin(), at, values.end());
    if (!(*at > 0.0f)) return 0.0;
    return std::clamp(std::round(-4.0 * std::log2(double(*at))) / 4.0, -12.0, 12.0);
}

class Book {
  public:
    Book(const Folder& folder, int page_width) : folder_(folder), page_width_(page_width) {}

    void add(const std::string& name, const std::string& file, const std::string& note) {
        if (!folder_.has(file)) return;
        const core::ImageChannels image = core::read_exr(folder_.file(file));
        Picture picture{image.width, image.height, image.rgb("")};
        if (picture.pixels.empty()) return;
        picture = shrunk(picture, page_width_);
        if (json_["pictures"].empty()) {
            json_["width"] = picture.width, json_["height"] = picture.height;
            json_["exposure"] = exposure_for(picture);
        }
        if (json_["width"] != picture.width || json_["height"] != picture.height) return;  // of another size
        json_["pictures"].push_back({{"name", name}, {"note", note}, {"source", data_url(picture)}});
    }
    const json& data() const { return json_; }

  private:
    const Folder& folder_;
    int page_width_;
    json json_ = {{"pictures", json::array()}};
};

std::string slug_of_method(const Results& results, const Curve& curve) {
    for (const json& m : results.facts.at("methods"))
        if (m.at("name") == curve.method) return m.at("slug").get<std::string>();
    return slug_of(curve.method);  // a peer, whose picture may lie beside its records
}

std::string flip_book(const Results& results, const Folder& folder, int page_width) {
    Book book(folder, page_width);
    book.add("reference", "reference.exr", "");
    for (const Curve& c : results.curves)
        book.add(c.method, slug_of_method(results, c) + ".exr",
                 fmt::format("{} passes, {:.3g} s, error {:.3g} %", c.passes, c.wall, 100.0 * c.error()));
    if (book.data().at("pictures").empty()) return "";
    return "<h2>Flip book</h2>\n<p>Keys 1 to 9 or the arrow keys flip, <b>+</b> and <b>-</b> zoom, <b>d</b> "
           "shows or hides the difference to the reference beside the picture. Pictures of the first seed at "
           "its end" +
           fmt::format(", here {} x {} pixels.</p>\n", book.data().at("width").get<int>(),
                       book.data().at("height").get<int>()) +
           "<div id=\"book\"><div id=\"buttons\"></div>\n<div><label>exposure <input id=\"exposure\" "
           "type=\"range\" min=\"-12\" max=\"12\" step=\"0.25\"></label> <span id=\"stops\"></span> "
           "<label>difference &times; <input id=\"gain\" type=\"range\" min=\"0\" max=\"8\" step=\"1\" "
           "value=\"2\"></label> <span id=\"factor\"></span> <button id=\"closer\">+</button><button "
           "id=\"farther\">-</button> <button id=\"beside\">d difference</button></div>\n<div "
           "id=\"caption\"></div>\n<div id=\"pair\"><canvas id=\"view\"></canvas><canvas "
           "id=\"difference\"></canvas></div></div>\n<script>\nconst book = " +
           script_json(book.data()) + ";\n" + page_script + "</script>\n";
}

std::string definitions(const Results& results) {
    std::string html = "<h2>What the words mean</h2>\n<dl>\n";
    const json summary = summary_json(results);
    for (const auto& [word, meaning] : summary.at("definitions").items())
        html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escaped(word), escaped(meaning.get<std::string>()));
    return html + "</dl>\n";
}

// For the first seed; the records say after how many passes it ended.
std::string method_command(const json& method, const Folder& folder, std::uint64_t seed) {
    auto words = method.at("command").get<std::vector<std::string>>();
    const auto name = method.at("name").get<std::string>();
    std::uint32_t passes = 0;
    for (const Record& r : folder.records())
        if (r.method == name && r.seed == seed) passes = std::max(passes, r.passes);
    words.insert(words.end(), {"--passes", std::to_string(passes)});
    return quoted(words);
}

std::string commands(const Results& results, const Folder& folder) {
    const json& facts = results.facts;
    std::vector<std::string> lines = {"# the reference",
                                      facts.at("reference").value("command", std::string()), "# this page",
                                      facts.value("command", std::string())};
    for (const json& m : facts.at("methods")) {
        lines.push_back("# " + m.at("name").get<std::string>());
        lines.push_back(method_command(m, folder, facts.at("seeds").at(0).get<std::uint64_t>()));
    }
    lines.push_back("# by mote at the commit " + facts.value("git_hash", std::string("unknown")));
    std::string html =
        "<h2>Commands</h2>\n<p>The methods' pictures with the same bits, for the first seed:</p>\n<pre>";
    for (const std::string& line : lines) html += escaped(line) + "\n";
    return html + "</pre>\n";
}

std::string introduction(const Results& results) {
    const json& f = results.facts;
    std::string text = fmt::format(
        "<p>{}, {} x {} pixels, {} thread{}, {} seed{} a method. {} Lower and further left is better; a "
        "straight fall by half for "
        "four times the "
        "time is noise, a line that flattens out has reached its bias.</p>\n",
        escaped(f.value("scene", std::string())), f.value("width", 0), f.value("height", 0),
        f.value("threads", 0), f.value("threads", 0) == 1 ? "" : "s", f.at("seeds").size(),
        f.at("seeds").size() == 1 ? "" : "s",
        escaped(f.value("turns", std::string("Methods took turns pass by pass, so that all of them saw the "
                                             "same machine."))));
    if (results.judge.floor > 0.0)
        text += fmt::format(
            "<p>The reference ({}) has a noise of {:.2g} %, which is subtracted from the errors pixel by "
            "pixel; what remains judges errors down to {:.2g} %. The standard error after &plusmn; is that "
            "of the "
            "subtraction.</p>\n",
            escaped(f.at("reference").value("integrator", std::string("unknown origin"))),
            100.0 * f.at("reference").value("noise", 0.0), 100.0 * results.judge.floor);
    else
        text += "<p><b>How exact the reference is, is not known.</b></p>\n";
    if (const std::string inherited = f.value("inherited", std::string()); !inherited.empty())
        text +=
            "<p>Where a method is silent, the scene's own settings hold: " + escaped(inherited) + ".</p>\n";
    if (!results.complete) text += "<p><b>This trade has not ended: the state so far.</b></p>\n";
    return text;
}

}  // namespace

std::string page_html(const Results& results, const Folder& folder, int page_width) {
    std::string plot = plot_svg(results.curves, results.judge.floor, results.title());
    return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" +
           escaped(results.title()) + "</title>\n<style>" + page_style + "</style>\n</head>\n<body>\n<h1>" +
           escaped(results.title()) + "</h1>\n" + introduction(results) + plot + "<h2>Table</h2>\n" +
           table(results) +
           "<p>Means over seeds at the end of each. A bias in bold is more than three standard errors from "
           "zero. Times in italics were not measured.</p>\n" +
           flip_book(results, folder, page_width) + definitions(results) + commands(results, folder) +
           "</body>\n</html>\n";
}

}  // namespace mote::trade
