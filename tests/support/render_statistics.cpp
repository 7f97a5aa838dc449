#include "tests/support/render_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "core/film/film.h"
#include "core/formats/xml/scene_loader.h"
#include "core/render/render_driver.h"
#include "integrators/register_integrators.h"
#include "lights/register_lights.h"
#include "media/register_media.h"

namespace mote::tests {

using namespace core;

const Registry& registry() {
    static const Registry instance = [] {
        Registry r;
        register_core(r);
        media::register_media(r);
        lights::register_lights(r);
        integrators::register_integrators(r);
        return r;
    }();
    return instance;
}

std::unique_ptr<Scene> scene_from(std::string xml, int size, const std::string& folder) {
    const std::string film = fmt::format(
        R"(<film type="hdrfilm"><integer name="width" value="{}"/><integer name="height" value="{}"/>
        <rfilter type="box"/></film></sensor>)",
        size, size);
    const auto start = xml.find("<sensor");
    const auto close = xml.find_first_of('>', start);
    if (close != std::string::npos && xml[close - 1] == '/') xml.replace(close - 1, 2, "></sensor>");
    if (const auto end = xml.find("</sensor>"); end != std::string::npos) xml.replace(end, 9, film);
    return load_scene_from_string(xml, folder, registry());
}

std::shared_ptr<const Integrator> integrator_from(const std::string& xml) {
    // A scene of its own around the element: the loader is the only way from XML to objects.
    const auto scene = scene_from("<scene version=\"3.0.0\">" + xml +
                                  "<sensor type=\"perspective\"/><emitter type=\"constant\"/></scene>");
    return scene->parts().integrator;
}

std::size_t RenderStatistics::layer(const std::string& name) const {
    const auto it = std::find(layers.begin(), layers.end(), name);
    if (it == layers.end()) throw std::out_of_range("no layer '" + name + "'");
    return std::size_t(it - layers.begin());
}

RenderStatistics RenderStatistics::scaled(double factor) const {
    RenderStatistics result = *this;
    const auto scale = [&](Estimate& e) { e.mean *= factor, e.variance_of_mean *= factor * factor; };
    for (auto& layer : result.blocks)
        for (Estimate& e : layer) scale(e);
    for (auto& layer : result.whole)
        for (Estimate& e : layer) scale(e);
    result.planted = true;
    return result;
}

namespace {

/// Running mean and squared deviations (Welford), stable for small variances.
struct Accumulator {
    double mean = 0.0, squares = 0.0;
    std::uint32_t n = 0;
    void add(double x) {
        ++n;
        const double delta = x - mean;
        mean += delta / n;
        squares += delta * (x - mean);
    }
    Estimate estimate() const { return {mean, n > 1 ? squares / (double(n) - 1.0) / n : 0.0}; }
};

struct Spec {
    int width, height, block;
};

class BlockAccumulator {
  public:
    BlockAccumulator(const Spec& spec, std::size_t layers)
        : spec_(spec),
          bx_((spec.width + spec.block - 1) / spec.block),
          by_((spec.height + spec.block - 1) / spec.block),
          blocks_(layers, std::vector<Accumulator>(std::size_t(bx_ * by_ * 3))),
          whole_(layers) {}

    void add(std::size_t layer, const std::vector<Vec3d>& pixels) {
        std::vector<Vec3d> sums(std::size_t(bx_ * by_), Vec3d(0.0));
        std::vector<int> counts(sums.size(), 0);
        Vec3d total(0.0);
        for (int y = 0; y < spec_.height; ++y)
            for (int x = 0; x < spec_.width; ++x) {
                const auto b = std::size_t((y / spec_.block) * bx_ + x / spec_.block);
                const Vec3d& value = pixels[std::size_t(y * spec_.width + x)];
                sums[b] += value, ++counts[b], total += value;
            }
        for (std::size_t b = 0; b < sums.size(); ++b)
            for (int c = 0; c < 3; ++c) blocks_[layer][b * 3 + std::size_t(c)].add(sums[b][c] / counts[b]);
        for (int c = 0; c < 3; ++c)
            whole_[layer][std::size_t(c)].add(total[c] / (spec_.width * spec_.height));
    }
    void finish(RenderStatistics& result) const {
        result.blocks_x = bx_, result.blocks_y = by_;
        for (std::size_t l = 0; l < blocks_.size(); ++l) {
            result.blocks.emplace_back();
            for (const Accumulator& a : blocks_[l]) result.blocks.back().push_back(a.estimate());
            result.whole.push_back(
                {whole_[l][0].estimate(), whole_[l][1].estimate(), whole_[l][2].estimate()});
        }
    }

  private:
    Spec spec_;
    int bx_, by_;
    std::vector<std::vector<Accumulator>> blocks_;
    std::vector<std::array<Accumulator, 3>> whole_;
};

std::vector<Vec3d> sum_of(const PassImage& image, const RenderStatistics& names,
                          const std::vector<std::string>& terms) {
    std::vector<Vec3d> sum(image.layer(0).size(), Vec3d(0.0));
    for (const std::string& term : terms) {
        const auto layer = image.layer(names.layer(term));
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += Vec3d(layer[i]);
    }
    return sum;
}

/// One pass of every part of the picture.
void run_parts(Estimator& estimator, const std::vector<Layer>& layers, const PassContext& pass,
               PassImage& image) {
    std::size_t parts = 1;
    for (const Layer& layer : layers) parts = std::max(parts, layer.part + 1);
    for (std::size_t part = 0; part < parts; ++part) {
        std::vector<std::size_t> of_part;
        for (std::size_t i = 0; i < layers.size(); ++i)
            if (layers[i].part == part) of_part.push_back(i);
        PassImage own(image.width(), image.height(), of_part.size());
        estimator.pass({pass.index, pass.filter, pass.cancelled, part}, own);
        for (std::size_t i = 0; i < of_part.size(); ++i) image.swap_layer(of_part[i], own, i);
    }
}

/// MOTE_TEST_SEEDS is added to every seed: an integrator that is right passes with any, up to the tests'
/// level.
std::uint64_t fresh_seeds() {
    const char* const text = std::getenv("MOTE_TEST_SEEDS");
    return text ? std::strtoull(text, nullptr, 10) : 0;
}

}  // namespace

RenderStatistics render_statistics(const Scene& scene, const Integrator& integrator, const RenderSpec& spec) {
    const std::vector<Layer> layers = integrator.layers(scene);
    const int width = scene.film().width, height = scene.film().height;
    RenderStatistics result;
    result.passes = spec.passes;
    for (const Layer& layer : layers) result.layers.push_back(layer.name);
    for (const auto& [name, terms] : spec.sums) result.layers.push_back(name);
    result.layers.push_back("beauty");

    RenderOptions options{spec.seed + fresh_seeds(), width, height, SamplerKind::independent};
    options.cells = spec.cells;
    const auto estimator = integrator.prepare(scene, options);
    const auto filter = make_pixel_filter("box", 0.5f, 0.5f);
    const std::atomic<bool> cancelled{false};
    PassImage image(width, height, layers.size());
    BlockAccumulator blocks({width, height, spec.block}, result.layers.size());
    for (std::uint32_t pass = 0; pass < spec.passes; ++pass) {
        image.clear();
        run_parts(*estimator, layers, {pass, *filter, cancelled}, image);
        std::vector<Vec3d> beauty(std::size_t(width * height), Vec3d(0.0));
        for (std::size_t l = 0; l < layers.size(); ++l) {
            std::vector<Vec3d> pixels;
            for (const Rgb& value : image.layer(l)) {
                if (!is_finite(value)) ++result.non_finite;
                pixels.emplace_back(value);
            }
            if (!layers[l].auxiliary)
                for (std::size_t i = 0; i < pixels.size(); ++i) beauty[i] += pixels[i];
            blocks.add(l, pixels);
        }
        for (std::size_t s = 0; s < spec.sums.size(); ++s)
            blocks.add(layers.size() + s, sum_of(image, result, spec.sums[s].second));
        blocks.add(layers.size() + spec.sums.size(), beauty);
    }
    blocks.finish(result);
    return result;
}

}  // namespace mote::tests
