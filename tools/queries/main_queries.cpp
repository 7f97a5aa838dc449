// mote_queries: granular visibility queries on pictures of random ellipses, for a figure of Engelhardt 2013,
// Ch. 6. CSV goes to stdout.
//
//   mote_queries ellipses   errors and times of region sets, of item buffers and of exact counts (Table 6.3)
//   mote_queries detail     meshes as fine as they are visible
//
// Exit codes as the mote command's: 0, 2 (usage), 3 (ours). Times are the least of --repeat runs.

#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <functional>
#include <iostream>

#include "experiments/benchmarks/ellipse_picture.h"
#include "screenspace/visibility/conflict_graph.h"
#include "screenspace/visibility/item_histogram.h"
#include "screenspace/visibility/region_queries.h"
#include "tools/queries/detail.h"

namespace {

using namespace mote;
using namespace mote::screenspace;

struct Options {
    std::vector<int> counts{100, 200, 300, 400, 500};
    benchmarks::EllipseSettings ellipses;
    RegionSettings regions;
    queries::DetailSettings detail;
    int pictures = 8, t = 4, repeat = 3, threads = 2;
};

double min_milliseconds(int repeat, const std::function<void()>& work) {
    double least = 1e30;
    for (int k = 0; k < repeat; ++k) {
        const auto start = std::chrono::steady_clock::now();
        work();
        const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
        least = std::min(least, taken.count());
    }
    return least;
}

/// Means over pictures.
struct Row {
    double visible = 0, pixels = 0, conflicts = 0, regions = 0, shared = 0, extra = 0, below = 0, wrong = 0;
    double graph_ms = 0, colour_ms = 0, sets_ms = 0, summed_ms = 0, histogram_ms = 0, exact_ms = 0,
           bare_ms = 0;

    static constexpr const char* names =
        "visible,pixels,conflicts,regions,shared,extra,below,wrong,graph_ms,colour_ms,sets_ms,summed_ms,"
        "histogram_ms,exact_ms,bare_ms";
    std::vector<double*> values() {
        return {&visible,  &pixels,    &conflicts, &regions,   &shared,       &extra,    &below,  &wrong,
                &graph_ms, &colour_ms, &sets_ms,   &summed_ms, &histogram_ms, &exact_ms, &bare_ms};
    }
};

void count(const benchmarks::EllipsePicture& picture, const Options& o, Row& row) {
    const auto n = std::uint32_t(picture.bounds.size());
    const ExactCounts exact(picture.view(), n);
    const RegionQueries queries(picture.view(), picture.bounds, o.regions);
    const ItemHistogram histogram(picture.view(), ItemLayout::of_objects(n, o.t));
    for (std::uint32_t item = 0; item < n; ++item) {
        const double truth = exact.pixels(item), extra = queries.pixels(item) - truth;
        row.visible += truth > 0, row.pixels += truth / n, row.extra += extra / n;
        row.below += extra < 0, row.wrong += histogram.pixels(item) != exact.pixels(item);
    }
    row.conflicts += double(queries.sets().conflicts()), row.shared += double(queries.sets().shared());
    row.regions += double(queries.sets().regions());
}

/// One picture; what region sets take holds graph and colouring, what summed areas take holds all.
void time(const benchmarks::EllipsePicture& picture, const Options& o, Row& row) {
    const auto n = std::uint32_t(picture.bounds.size());
    std::vector<PixelRectangle> rectangles;
    for (const ItemBounds& b : picture.bounds)
        rectangles.push_back(intersection(b.rectangle, picture.view().frame()));
    const ConflictGraph graph(rectangles);
    std::size_t sink = 0;
    const auto all = [&](const auto& queries) {
        for (std::uint32_t item = 0; item < n; ++item) sink += queries.pixels(item);
    };
    row.graph_ms = min_milliseconds(o.repeat, [&] { sink += ConflictGraph(rectangles).edges(); });
    row.colour_ms = min_milliseconds(o.repeat, [&] { sink += colour(graph, o.regions.channels).size(); });
    row.sets_ms = min_milliseconds(
        o.repeat, [&] { sink += RegionSets(picture.bounds, picture.view().frame(), o.regions).regions(); });
    row.summed_ms =
        min_milliseconds(o.repeat, [&] { all(RegionQueries(picture.view(), picture.bounds, o.regions)); });
    row.histogram_ms = min_milliseconds(
        o.repeat, [&] { all(ItemHistogram(picture.view(), ItemLayout::of_objects(n, o.t))); });
    row.exact_ms = min_milliseconds(o.repeat, [&] { all(ExactCounts(picture.view(), n)); });
    row.bare_ms = min_milliseconds(o.repeat, [&] {
        for (const std::uint32_t item : picture.items) sink += item;
    });
    if (sink == 0) std::fputs("nothing was counted\n", stderr);
}

void ellipses(const Options& o) {
    std::printf("count,%s\n", Row::names);
    for (const int n : o.counts) {
        Row row;
        benchmarks::EllipseSettings settings = o.ellipses;
        settings.count = n;
        for (int k = 0; k < o.pictures; ++k) {
            settings.seed = std::uint64_t(k);
            count(benchmarks::make_ellipses(settings), o, row);
        }
        for (double* v : row.values()) *v /= o.pictures;
        time(benchmarks::make_ellipses(settings), o, row);
        std::printf("%d", n);
        for (const double* v : row.values()) std::printf(",%.6g", *v);
        std::puts("");
    }
}

void detail(const Options& o) {
    std::puts("by,triangles,query_seconds,seconds,changed,hidden");
    for (const queries::DetailRow& row : queries::compare_details(o.detail))
        std::printf("%s,%.0f,%.6g,%.6g,%.6g,%.0f\n", row.by, row.triangles, row.query_seconds, row.seconds,
                    row.changed, row.hidden);
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Granular visibility queries, for a figure");
    app.require_subcommand(1);
    Options o;
    CLI::App* command = app.add_subcommand("ellipses", "random ellipses, one before the other");
    command->add_option("--counts", o.counts, "of ellipses")->delimiter(',');
    command->add_option("--width", o.ellipses.width, "pixels")->check(CLI::Range(1, 16384));
    command->add_option("--height", o.ellipses.height, "pixels")->check(CLI::Range(1, 16384));
    command->add_option("--min-radius", o.ellipses.min_radius, "pixels");
    command->add_option("--largest-radius", o.ellipses.largest_radius, "pixels");
    command->add_option("--aspect", o.ellipses.aspect, "of the longer to the shorter axis");
    command->add_option("--spread", o.ellipses.spread,
                        "share of the picture that middles lie in, along an edge");
    command->add_option("--channels", o.regions.channels, "of colour");
    command->add_option("--rectangles", o.regions.max_rectangles, "that an item is split into at most");
    command->add_option("--pictures", o.pictures, "that means are over");
    command->add_option("--tiles", o.t, "t: 2^t x 2^t tiles of the item buffer");
    command->add_option("--repeat", o.repeat, "times that everything is timed");
    command->add_option("--threads", o.threads, "of TBB");
    CLI::App* detail_command = app.add_subcommand("detail", "meshes as fine as they are visible");
    detail_command->add_option("--balls", o.detail.balls, "in the crowd");
    detail_command->add_option("--radius", o.detail.radius, "of balls, in the mean [m], in a cube of 2 m");
    detail_command->add_option("--finest", o.detail.finest, "cells from pole to pole of the finest mesh");
    detail_command->add_option("--threads", o.threads, "of TBB");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                          std::size_t(o.threads));
        detail_command->parsed() ? detail(o) : ellipses(o);
        return 0;
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 3;
    }
}
