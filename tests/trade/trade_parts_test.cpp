// The parts of mote trade on hand-made records: curves, front, times, turns, CSV, JSON lines, pictures.
#include <cmath>
#include <set>

#include "core/objects/error.h"
#include "tests/support/catch.h"
#include "trade/curves.h"
#include "trade/draw.h"
#include "trade/json_lines.h"
#include "trade/packed_picture.h"
#include "trade/run.h"

using namespace mote::trade;
using mote::core::InputError;
using mote::core::Rgb;
using Kind = Reach::Kind;

namespace {

Record record(const std::string& method, std::uint64_t seed, std::uint32_t passes, double wall,
              double error) {
    Record r;
    r.method = method, r.integrator = "path", r.seed = seed, r.passes = passes, r.wall = wall,
    r.error = error;
    r.relmse = error * error, r.relmse_trimmed = r.relmse, r.bias = 0.0, r.bias_se = 0.01, r.cpu = wall;
    return r;
}

// error = scale * seconds^exponent at 1, 2, 4, ... passes of a second each.
std::vector<Record> power_law(double scale, double exponent, int count, double build = 0.0) {
    std::vector<Record> records;
    for (int i = 0; i < count; ++i) {
        const double t = std::ldexp(1.0, i);
        records.push_back(record("m", 1, 1u << i, build + t, scale * std::pow(t, exponent)));
        records.back().build = build;
    }
    records.back().final = true;
    return records;
}

Curve curve_of(const std::vector<Record>& records, double floor = 0.0) {
    return make_curves(records, floor).at(0);
}

/// Pixels that pack_rgbe() packed, as the page decodes them.
Picture unpack_rgbe(std::span<const std::uint8_t> bytes, int width, int height) {
    Picture picture{width, height, {}};
    const std::size_t n = std::size_t(width) * std::size_t(height);
    for (std::size_t p = 0; p < n; ++p) {
        Rgb c(0.0f);
        const int exponent = bytes[3 * (n + p)];
        for (int i = 0; i < 3 && exponent > 0; ++i)
            c[i] = float(std::ldexp(bytes[3 * p + std::size_t(i)] + 0.5, exponent - 136));
        picture.pixels.push_back(c);
    }
    return picture;
}

}  // namespace

TEST_CASE("A curve is the mean over seeds, with their range", "[trade]") {
    std::vector<Record> records = {record("a", 1, 1, 1.0, 0.4), record("b", 1, 1, 5.0, 0.9),
                                   record("a", 2, 1, 3.0, 0.2), record("a", 1, 2, 2.0, 0.2),
                                   record("a", 2, 2, 6.0, 0.1), record("a", 1, 3, 9.0, 0.05)};
    records[3].final = false, records[4].final = records[5].final = true;
    const auto curves = make_curves(records, 0.08);
    REQUIRE(curves.size() == 2);
    const Curve& a = curves[0];
    CHECK(a.method == "a");
    CHECK(a.seeds == 2);
    CHECK(a.complete);
    CHECK_FALSE(curves[1].complete);
    // One pass, two passes, and the ends after two and three.
    REQUIRE(a.points.size() == 3);
    CHECK(a.points[0].wall == Approx(2.0));
    CHECK(a.points[0].error == Approx(0.3));
    CHECK(a.points[0].lowest == Approx(0.2));
    CHECK(a.points[0].highest == Approx(0.4));
    CHECK(a.points[1].wall == Approx(4.0));
    CHECK(a.points[2].passes == Approx(2.5));
    CHECK(a.points[2].error == Approx(0.075));
    CHECK(a.points[2].below_reference);
    CHECK_FALSE(a.points[1].below_reference);
    CHECK(a.relmse == Approx((0.01 + 0.0025) / 2.0));
    CHECK(a.inefficiency() == Approx(0.075 * 0.075 * 7.5));
    CHECK(a.bias_se == Approx(std::sqrt(2.0) * 0.01 / 2.0));
}

TEST_CASE("The standard error of a mean has the noise of the reference, and that of the seeds", "[trade]") {
    std::vector<Record> records = {record("a", 1, 4, 1.0, 0.2)};
    records[0].error_se = 0.03;
    CHECK(curve_of(records).error_se() == Approx(0.03));
    // Two seeds: their spread is 0.1 / sqrt 2 each, 0.05 of the mean; the reference's noise is the same for
    // both.
    records.push_back(record("a", 2, 4, 1.0, 0.3));
    records[1].error_se = 0.03;
    CHECK(curve_of(records).error_se() == Approx(std::hypot(0.03, 0.05)));
    records[0].error_se = mote::trade::unknown;
    CHECK(curve_of(records).error_se() == Approx(0.05));
}

TEST_CASE("With four seeds the standard error of the bias is at least that of their spread", "[trade]") {
    std::vector<Record> records;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        records.push_back(record("a", seed, 4, 1.0, 0.1));
        records.back().bias = seed % 2 ? 0.3 : -0.3;
    }
    CHECK(curve_of(records).bias_se == Approx(0.3 * std::sqrt(4.0 / 3.0) / 2.0));
}

TEST_CASE("The Pareto front holds what no point beats", "[trade]") {
    const std::vector<Record> records = {record("a", 1, 1, 1.0, 0.5),  record("a", 1, 2, 2.0, 0.3),
                                         record("a", 1, 4, 4.0, 0.2),  record("b", 1, 1, 1.5, 0.4),
                                         record("b", 1, 2, 3.0, 0.35), record("b", 1, 4, 6.0, 0.01),
                                         record("c", 1, 1, 0.5, 0.01)};
    auto curves = make_curves(std::span(records).first(6), 0.05);
    mark_pareto_front(curves);
    CHECK(curves[0].points[0].on_front);
    CHECK(curves[0].points[1].on_front);
    CHECK(curves[0].points[2].on_front);
    CHECK(curves[1].points[0].on_front);
    CHECK_FALSE(curves[1].points[1].on_front);  // beaten by a after 2 s
    CHECK_FALSE(curves[1].points[2].on_front);  // below what the reference can judge
    curves = make_curves(records, 0.05);
    mark_pareto_front(curves);
    CHECK_FALSE(curves[0].points[0].on_front);  // c was below the floor before
    CHECK_FALSE(curves[2].points[0].on_front);  // but how far is unknown
    curves = make_curves(records, 0.0);
    mark_pareto_front(curves);
    CHECK_FALSE(curves[0].points[0].on_front);  // c was there before, and better
    CHECK(curves[2].points[0].on_front);
}

TEST_CASE("A time that was measured is read off between two points", "[trade]") {
    const Reach r = time_to_reach(curve_of(power_law(0.4, -0.5, 10)), 0.05, {0.001, 0.0});
    CHECK(r.kind == Kind::measured);
    CHECK(r.seconds == Approx(64.0));
    const Reach between = time_to_reach(curve_of(power_law(0.4, -0.5, 10)), 0.045, {0.001, 0.0});
    CHECK(between.seconds == Approx(std::pow(0.4 / 0.045, 2.0)));
    CHECK(time_to_reach(curve_of(power_law(0.04, -0.5, 3)), 0.05, {0.0, 0.0}).kind == Kind::at_most);
    // A curve that rises again has not arrived yet.
    std::vector<Record> bouncing = power_law(0.4, -0.5, 10);
    bouncing[8].error = 0.06;
    CHECK(time_to_reach(curve_of(bouncing), 0.05, {0.0, 0.0}).seconds > 256.0);
}

TEST_CASE("A time beyond the last point is extrapolated and marked, or not given", "[trade]") {
    const Curve falling = curve_of(power_law(0.4, -0.5, 5, 3.0));
    const Reach r = time_to_reach(falling, 0.01, {0.001, 0.0});
    CHECK(r.kind == Kind::extrapolated);
    CHECK(r.seconds == Approx(3.0 + 1600.0));  // what was spent on building does not grow
    CHECK(r.slope == Approx(-0.5));
    CHECK(to_text(r, falling).find("extrapolated") != std::string::npos);
    CHECK(to_text(r, falling).front() == '~');

    CHECK(time_to_reach(curve_of(power_law(0.4, -0.5, 2)), 0.01, {0.001, 0.0}).kind == Kind::unclear);
    CHECK(time_to_reach(curve_of(power_law(0.4, -0.1, 6)), 0.01, {0.001, 0.0}).kind == Kind::unclear);
    CHECK(time_to_reach(falling, 0.01, {0.02, 0.0}).kind == Kind::below_reference);
}

TEST_CASE("A biased method never gets there, and says so with its bias", "[trade]") {
    std::vector<Record> flat = power_law(0.12, -0.05, 6), falling = power_law(0.4, -0.5, 5);
    for (Record& r : flat) r.bias = -0.08, r.bias_se = 0.001;
    const Curve curve = curve_of(flat);
    const Reach r = time_to_reach(curve, 0.01, {0.001, 0.0});
    CHECK(r.kind == Kind::never);
    CHECK(to_text(r, curve) == "not with a bias of -8 %");
    // It still falls, but towards its bias; a larger error it does reach.
    for (Record& f : falling) f.bias = 0.03, f.bias_se = 0.001;
    CHECK(time_to_reach(curve_of(falling), 0.02, {0.001, 0.0}).kind == Kind::never);
    CHECK(time_to_reach(curve_of(falling), 0.05, {0.001, 0.0}).kind == Kind::extrapolated);
    // The bias is known better than the errors: a coarse reference is enough for it.
    CHECK(time_to_reach(curve, 0.01, {0.05, 0.0}).kind == Kind::never);
    CHECK(time_to_reach(curve, 0.01, {0.05, 0.03}).kind == Kind::below_reference);
    // Bias within the error of the reference's own mean is none.
    CHECK(bias_is_significant(curve, 0.0));
    CHECK_FALSE(bias_is_significant(curve, 0.03));
    flat.back().bias_se = unknown;
    CHECK_FALSE(bias_is_significant(curve_of(flat), 0.0));
}

TEST_CASE("What lies below the reference is not judged, but does lie below", "[trade]") {
    const Curve curve = curve_of(power_law(0.4, -0.5, 10), 0.051);
    const Reach r = time_to_reach(curve, 0.052, {0.051, 0.0});
    CHECK(r.kind == Kind::at_most);
    CHECK(r.seconds == Approx(64.0));
}

TEST_CASE("Turns keep the methods side by side in time", "[trade]") {
    const std::vector<double> cost = {1.0, 2.7, 6.1};
    std::vector<double> spent(3, 0.0);
    for (int i = 0; i < 1000; ++i) {
        const std::size_t turn = next_turn(spent, {true, true, true});
        spent[turn] += cost[turn];
        const auto [low, high] = std::minmax_element(spent.begin(), spent.end());
        REQUIRE(*high - *low <= 6.1);
    }
    CHECK(next_turn({1.0, 0.5, 2.0}, {true, false, true}) == 0);
    CHECK_THROWS_AS(next_turn({1.0}, {false}), std::logic_error);
    CHECK(seeds_beside(2, 3) == std::vector<std::uint64_t>{1, 3, 4});
    CHECK(seeds_beside({}, 2) == std::vector<std::uint64_t>{1, 2});
}

TEST_CASE("Records survive CSV bit by bit", "[trade]") {
    std::vector<Record> records = {record("a, \"b\"\nc", 3, 17, 1.0 / 3.0, 0.1 + 0.2)};
    records[0].bias_se = unknown, records[0].final = true, records[0].settings = "bound=2 paths=4";
    const std::string text = to_csv(records);
    const auto back = records_from_csv(text, "x.csv");
    REQUIRE(back.size() == 1);
    CHECK(back[0].method == records[0].method);
    CHECK(back[0].settings == records[0].settings);
    CHECK(back[0].wall == records[0].wall);
    CHECK(back[0].error == records[0].error);
    CHECK(back[0].seed == 3);
    CHECK(back[0].passes == 17);
    CHECK(back[0].final);
    CHECK_FALSE(back[0].below_reference);
    CHECK(std::isnan(back[0].bias_se));
    CHECK(to_csv(back) == text);
}

TEST_CASE("Damaged CSV is refused with its line", "[trade]") {
    const auto message = [](const std::string& text) -> std::string {
        try {
            records_from_csv(text, "x.csv");
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    };
    CHECK_THAT(message(""), ContainsSubstring("header"));
    CHECK_THAT(message("method,seed,passes,wall_s,eror\n"), ContainsSubstring("'error'"));
    CHECK_THAT(message("method,seed,passes,wall_s\n"), ContainsSubstring("no column 'error'"));
    const std::string head = "method,seed,passes,wall_s,error\n";
    CHECK_THAT(message(head + "a,1,1,2,0.1\nb,1,1,x,0.1\n"), ContainsSubstring("x.csv:3: wall_s"));
    CHECK_THAT(message(head + "a,1,1,2\n"), ContainsSubstring("x.csv:2: 4 fields"));
    CHECK_THAT(message(head + "a,1,1,0,0.1\n"), ContainsSubstring("above 0"));
    CHECK_THAT(message(head + "a,-1,1,1,0.1\n"), ContainsSubstring("whole number"));
    CHECK_THAT(message(head + "\"a,1,1,1,0.1\n"), ContainsSubstring("no end"));
    CHECK(records_from_csv(head + "a,1,1,2,0.1\r\n\n", "x.csv").size() == 1);
}

TEST_CASE("Keys and elements of JSON have lines", "[trade]") {
    const JsonLines file("{\n \"a\": 1,\n \"list\": [\n  {\"x\": [1, 2]},\n  {\n   \"y\": null}]\n}",
                         "f.json");
    CHECK(file.root()["list"].size() == 2);
    CHECK(file.where("/a").line == 2);
    CHECK(file.where("/list").line == 3);
    CHECK(file.where("/list/0").line == 4);
    CHECK(file.where("/list/1").line == 5);
    CHECK(file.where("/list/1/y").line == 6);
    CHECK(file.where("/a").file == "f.json");
    CHECK_THROWS_WITH(JsonLines("{\"a\": 1,\n\"a\": 2}", "f.json"),
                      ContainsSubstring("f.json:2: 'a' is given twice"));
    CHECK_THROWS_WITH(JsonLines("{\n\n\"a\": }", "f.json"), ContainsSubstring("f.json:3: not JSON"));
    CHECK_THROWS_AS(JsonLines("", "f.json"), InputError);
}

TEST_CASE("Packed pictures keep eight bits of the largest channel", "[trade]") {
    Picture picture{3,
                    2,
                    {Rgb(0.0f), Rgb(1e-3f, 2e-3f, 5e-4f), Rgb(1.0f, 0.5f, 0.25f), Rgb(1e6f, 3.0f, 0.0f),
                     Rgb(0.9999f), Rgb(std::nanf(""), 1.0f, 1.0f)}};
    const auto bytes = pack_rgbe(picture);
    REQUIRE(bytes.size() == 36);
    const Picture back = unpack_rgbe(bytes, 3, 2);
    for (std::size_t p = 0; p < 5; ++p) {
        const float largest = std::max({picture.pixels[p].x, picture.pixels[p].y, picture.pixels[p].z});
        for (int c = 0; c < 3; ++c)
            CHECK(std::fabs(back.pixels[p][c] - picture.pixels[p][c]) <= largest / 255.0f);
    }
    CHECK(back.pixels[0] == Rgb(0.0f));
    CHECK(back.pixels[5] == Rgb(0.0f));

    const Picture small = shrunk(picture, 2);
    CHECK(small.width == 2);
    CHECK(small.height == 1);
    CHECK(small.pixels[0].y == Approx((0.0 + 2e-3 + 3.0 + 0.9999) / 4.0));

    const auto text = [](const std::string& s) {
        return base64(std::as_bytes(std::span(s.data(), s.size())));
    };
    CHECK(text("") == "");
    CHECK(text("f") == "Zg==");
    CHECK(text("fo") == "Zm8=");
    CHECK(text("foo") == "Zm9v");
    CHECK(text("foobar") == "Zm9vYmFy");
}

TEST_CASE("The plot shows every method by name, the front and the floor, and no broken number", "[trade]") {
    std::vector<Record> records = power_law(0.4, -0.5, 6);
    records.push_back(record("a <b> & c", 1, 1, 3.0, 0.2));
    records.push_back(record("a <b> & c", 2, 1, 4.0, 0.3));
    auto curves = make_curves(records, 0.15);
    mark_pareto_front(curves);
    const std::string svg = plot_svg(curves, 0.15, "title");
    CHECK_THAT(svg, ContainsSubstring("a &lt;b&gt; &amp; c") && ContainsSubstring(">m</text>") &&
                        ContainsSubstring("judges down to 15 %"));
    CHECK_THAT(svg, !ContainsSubstring("nan") && !ContainsSubstring("inf"));
    CHECK_THAT(plot_svg({}, 0.0, "empty"), ContainsSubstring("</svg>"));
}

TEST_CASE("An integrator has one colour in all plots, and no two of eleven methods share one", "[trade]") {
    std::vector<Curve> curves(11);
    curves[3].integrator = "mote_vpl", curves[7].integrator = "path", curves[8].integrator = "mote_vpl";
    const std::vector<std::string> colours = curve_colours(curves);
    CHECK(std::set<std::string>(colours.begin(), colours.end()).size() == 11);
    const std::vector<Curve> others = {curves[7], curves[3]};
    CHECK(curve_colours(others) == std::vector<std::string>{colours[7], colours[3]});
}

TEST_CASE("The longest name of a method ends within the plot", "[trade]") {
    const std::string name = "multidimensional lightcuts, rays shared";
    auto curves = make_curves(std::vector{record(name, 1, 1, 3.0, 0.2), record(name, 2, 1, 4.0, 0.1)}, 0.0);
    const std::string svg = plot_svg(curves, 0.0, "title");
    const std::size_t label = svg.rfind("<text x=\"");
    REQUIRE(label != std::string::npos);
    // Bold letters of 13 pixels are 8.2 wide on average, at most; the plot is 960 wide.
    CHECK(std::stod(svg.substr(label + 9)) + 8.2 * double(name.size()) <= 960.0);
}
