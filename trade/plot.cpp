// Axes, bands, lines, markers and labels, in this order from back to front.
#include "trade/draw.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/math/vec.h"

namespace mote::trade {

namespace {

constexpr double width = 960.0, height = 560.0;
constexpr double left = 78.0, top = 48.0, bottom = 492.0;  // of the axes; labels on the right
constexpr double label_distance = 17.0, label_gap = 14.0;

/// Width of a label in bold letters of 13 pixels, at most.
double label_width(const std::string& text) { return 8.2 * double(text.size()); }

/// Right end of the axes, which leaves room for the longest label.
double axes_end(std::span<const Curve> curves) {
    double longest = 0.0;
    for (const Curve& c : curves) longest = std::max(longest, label_width(c.method));
    return std::clamp(width - longest - label_gap - 6.0, 0.5 * width, 760.0);
}

// Okabe and Ito's colours without the yellow, which is too light on white; behind them four of Tol's.
constexpr std::array<const char*, 11> palette = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                 "#e69f00", "#56b4e9", "#000000", "#882255",
                                                 "#999933", "#332288", "#888888"};

/// Colour of the first curve of an integrator, in every plot.
constexpr std::pair<const char*, std::size_t> integrator_colours[] = {
    {"path", 0},          {"volpath", 0},         {"mote_layers", 1},
    {"mote_vpl", 2},      {"mote_ray_lights", 3}, {"mote_photon_map", 4},
    {"mote_epipolar", 5}, {"mote_ray_bundles", 6}};

/// One axis: a range of powers of ten, rounded outwards to 1, 2 or 5.
class Axis {
  public:
    Axis(double lowest, double highest, double from, double to) : from_(from), to_(to) {
        low_ = rounded(lowest, false), high_ = rounded(highest, true);
        if (high_ <= low_ * 1.5) high_ = rounded(low_ * 10.0, true);
    }
    double at(double value) const {
        const double v = std::clamp(value, low_, high_);
        return from_ + (to_ - from_) * std::log(v / low_) / std::log(high_ / low_);
    }
    bool holds(double value) const { return value >= low_ && value <= high_; }
    /// 1, 2 and 5 times every power of ten in the range.
    std::vector<double> ticks() const {
        std::vector<double> result;
        for (int e = int(std::floor(std::log10(low_))) - 1; std::pow(10.0, e) <= high_; ++e)
            for (const double step : {1.0, 2.0, 5.0}) {
                const double v = step * std::pow(10.0, e);
                if (v >= low_ * 0.999 && v <= high_ * 1.001) result.push_back(v);
            }
        return result;
    }

  private:
    static double rounded(double v, bool up) {
        const double decade = std::pow(10.0, std::floor(std::log10(v)));
        double best = up ? 10.0 * decade : decade;
        for (const double step : {1.0, 2.0, 5.0})
            if (up ? step * decade >= v * 0.999 && step * decade < best : step * decade <= v * 1.001)
                best = step * decade;
        return best;
    }
    double low_, high_, from_, to_;
};

std::string point_text(double x, double y) { return fmt::format("{:.1f},{:.1f}", x, y); }

class Plot {
  public:
    Plot(std::span<const Curve> curves, double floor)
        : curves_(curves),
          colours_(curve_colours(curves)),
          floor_(floor),
          right_(axes_end(curves)),
          x_(x_axis(curves, right_)),
          y_(y_axis(curves, floor)) {}

    std::string draw(const std::string& title) {
        text_ = fmt::format(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
            "font-family=\"Helvetica, Arial, sans-serif\" font-size=\"13\">\n"
            "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
            width, height);
        put("<text x=\"{}\" y=\"26\" font-size=\"16\" font-weight=\"bold\">{}</text>\n", left,
            escaped(title));
        axes();
        reference_floor();
        for (std::size_t i = 0; i < curves_.size(); ++i) band(i);
        front();
        for (std::size_t i = 0; i < curves_.size(); ++i) line(i);
        labels();
        return text_ + "</svg>\n";
    }

  private:
    template <typename... Args>
    void put(fmt::format_string<Args...> format, Args&&... args) {
        text_ += fmt::format(format, std::forward<Args>(args)...);
    }
    static Axis x_axis(std::span<const Curve> curves, double right) {
        double low = 1e300, high = 0.0;
        for (const Curve& c : curves)
            for (const CurvePoint& p : c.points) low = std::min(low, p.wall), high = std::max(high, p.wall);
        return high > 0.0 ? Axis(low, high, left, right) : Axis(0.1, 10.0, left, right);
    }
    static Axis y_axis(std::span<const Curve> curves, double floor) {
        double low = 1e300, high = 0.0;
        for (const Curve& c : curves)
            for (const CurvePoint& p : c.points)
                low = std::min(low, p.lowest), high = std::max(high, p.highest);
        if (!(high > 0.0)) return {0.01, 1.0, bottom, top};
        // The floor belongs into the picture when it is near.
        if (floor > low / 5.0) low = std::min(low, floor * 0.9);
        return {low, high, bottom, top};
    }

    void axes() {
        const auto grid = [&](double x0, double y0, double x1, double y1, bool decade) {
            put("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\"/>\n", x0, y0, x1, y1,
                decade ? "#d4d4d4" : "#eeeeee");
        };
        const auto is_decade = [](double v) {
            return std::fabs(std::log10(v) - std::round(std::log10(v))) < 1e-6;
        };
        const std::vector<double> times = x_.ticks(), errors = y_.ticks();
        for (const double t : times) grid(x_.at(t), top, x_.at(t), bottom, is_decade(t));
        for (const double e : errors) grid(left, y_.at(e), right_, y_.at(e), is_decade(e));
        put("<g fill=\"#444444\" text-anchor=\"middle\">\n");
        for (const double t : times)
            if (times.size() <= 12 || is_decade(t))
                put("<text x=\"{:.1f}\" y=\"{}\">{:g} s</text>\n", x_.at(t), bottom + 18.0, t);
        put("</g>\n<g fill=\"#444444\" text-anchor=\"end\">\n");
        for (const double e : errors)
            if (errors.size() <= 16 || is_decade(e))
                put("<text x=\"{}\" y=\"{:.1f}\">{:g} %</text>\n", left - 8.0, y_.at(e) + 4.5, 100.0 * e);
        put("</g>\n<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#888888\"/>\n",
            left, top, right_ - left, bottom - top);
        put("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">wall time</text>\n", 0.5 * (left + right_),
            bottom + 40.0);
        put("<text x=\"18\" y=\"{0}\" text-anchor=\"middle\" transform=\"rotate(-90 18 {0})\">relative "
            "RMSE</text>\n",
            0.5 * (top + bottom));
        put("<text x=\"{}\" y=\"{}\" font-size=\"12\" fill=\"#444444\">Lines: mean over seeds; bands: their "
            "range. Thick grey: the Pareto front, which no method beats in both time and error.</text>\n",
            left, bottom + 60.0);
    }
    void reference_floor() {
        if (!y_.holds(floor_)) return;
        const double y = y_.at(floor_);
        put("<rect x=\"{}\" y=\"{:.1f}\" width=\"{}\" height=\"{:.1f}\" fill=\"#f3f3f3\"/>\n", left, y,
            right_ - left, bottom - y);
        put("<path d=\"M{} {:.1f}H{}\" stroke=\"#666666\" stroke-dasharray=\"6 4\"/>\n", left, y, right_);
        // Above the line where there is no room below it.
        put("<text x=\"{}\" y=\"{:.1f}\" font-size=\"12\" fill=\"#555555\">the reference judges down to "
            "{:.2g} %</text>\n",
            left + 6.0, y + 15.0 < bottom ? y + 15.0 : y - 5.0, 100.0 * floor_);
    }
    void band(std::size_t index) {
        const Curve& curve = curves_[index];
        if (curve.seeds < 2 || curve.points.size() < 2) return;
        std::string path;
        for (const CurvePoint& p : curve.points) path += point_text(x_.at(p.wall), y_.at(p.highest)) + " ";
        for (auto p = curve.points.rbegin(); p != curve.points.rend(); ++p)
            path += point_text(x_.at(p->wall), y_.at(p->lowest)) + " ";
        put("<polygon points=\"{}\" fill=\"{}\" fill-opacity=\"0.16\"/>\n", path, colours_[index]);
    }
    // Errors between two points of the front are those of the earlier one until the later one is there.
    void front() {
        std::vector<const CurvePoint*> points;
        double end = core::infinity;  // below the reference's floor the front is unknown
        for (const Curve& c : curves_)
            for (const CurvePoint& p : c.points) {
                if (p.on_front) points.push_back(&p);
                if (p.below_reference) end = std::min(end, p.wall);
            }
        std::sort(points.begin(), points.end(), [](auto* a, auto* b) { return a->wall < b->wall; });
        if (points.empty()) return;
        std::string path = "M" + point_text(x_.at(points[0]->wall), y_.at(points[0]->error));
        for (std::size_t i = 1; i < points.size(); ++i)
            path += fmt::format("H{:.1f}V{:.1f}", x_.at(points[i]->wall), y_.at(points[i]->error));
        if (end < core::infinity)
            path += fmt::format("H{:.1f}V{:.1f}", x_.at(end), y_.at(floor_));
        else
            path += fmt::format("H{}", right_);
        put("<path d=\"{}\" fill=\"none\" stroke=\"#b0b0b0\" stroke-width=\"6\" stroke-opacity=\"0.75\" "
            "stroke-linejoin=\"round\"/>\n",
            path);
    }
    void line(std::size_t index) {
        const Curve& curve = curves_[index];
        const std::string colour = colours_[index];
        std::string path;
        for (const CurvePoint& p : curve.points) path += point_text(x_.at(p.wall), y_.at(p.error)) + " ";
        put("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"{}/>\n", path, colour,
            curve.peer ? " stroke-dasharray=\"7 4\"" : "");
        for (const CurvePoint& p : curve.points)
            marker(index, x_.at(p.wall), y_.at(p.error), p.below_reference ? "#ffffff" : colour);
    }
    void marker(std::size_t index, double x, double y, const std::string& fill) {
        const std::string style =
            fmt::format("fill=\"{}\" stroke=\"{}\" stroke-width=\"1.5\"", fill, colours_[index]);
        const double r = 4.0;
        switch (index % 4) {
            case 0:
                put("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" {}/>\n", x, y, r, style);
                break;
            case 1:
                put("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\" {}/>\n", x - 3.5, y - 3.5,
                    7.0, 7.0, style);
                break;
            case 2:
                put("<path d=\"M{:.1f} {:.1f}l5 8h-10z\" {}/>\n", x, y - 5.0, style);
                break;
            default:
                put("<path d=\"M{:.1f} {:.1f}l5 5l-5 5l-5 -5z\" {}/>\n", x, y - 5.0, style);
        }
    }
    // At the end of each line, pushed apart where they would overlap.
    void labels() {
        struct Label {
            std::size_t index;
            double x, y, shown;
        };
        std::vector<Label> all;
        for (std::size_t i = 0; i < curves_.size(); ++i)
            if (!curves_[i].points.empty()) {
                const CurvePoint& end = curves_[i].points.back();
                all.push_back({i, x_.at(end.wall), y_.at(end.error), y_.at(end.error)});
            }
        std::stable_sort(all.begin(), all.end(), [](const Label& a, const Label& b) { return a.y < b.y; });
        for (std::size_t i = 1; i < all.size(); ++i)
            all[i].shown = std::max(all[i].shown, all[i - 1].shown + label_distance);
        double lowest = bottom;
        for (auto l = all.rbegin(); l != all.rend(); ++l)
            l->shown = std::min(l->shown, lowest), lowest = l->shown - label_distance;
        for (const Label& l : all) {
            put("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\" stroke-width=\"0.8\" "
                "fill=\"none\"/>\n",
                l.x + 5.0, l.y, right_ + 10.0, l.shown, colours_[l.index]);
            put("<text x=\"{}\" y=\"{:.1f}\" fill=\"{}\" font-weight=\"bold\">{}</text>\n",
                right_ + label_gap, l.shown + 4.5, colours_[l.index], escaped(curves_[l.index].method));
        }
    }

    std::span<const Curve> curves_;
    std::vector<std::string> colours_;  ///< by curve
    double floor_, right_;              ///< smallest error that is judged; end of the axes
    Axis x_, y_;
    std::string text_;
};

}  // namespace

std::vector<std::string> curve_colours(std::span<const Curve> curves) {
    std::vector<std::string> colours(curves.size());
    std::array<bool, palette.size()> taken{};
    for (std::size_t i = 0; i < curves.size(); ++i)
        for (const auto& [integrator, colour] : integrator_colours)
            if (curves[i].integrator == integrator && !taken[colour])
                colours[i] = palette[colour], taken[colour] = true;
    std::size_t next = 0;
    for (std::string& colour : colours) {
        if (!colour.empty()) continue;
        while (next < palette.size() && taken[next]) ++next;
        colour = palette[next++ % palette.size()];
    }
    return colours;
}

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else if (c == '"')
            result += "&quot;";
        else if (static_cast<unsigned char>(c) >= 0x20)
            result += c;
    }
    return result;
}

std::string plot_svg(std::span<const Curve> curves, double floor, const std::string& title) {
    return Plot(curves, floor).draw(title);
}

}  // namespace mote::trade
