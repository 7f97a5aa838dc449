#include "lights/selection/matrix/matrix_rows.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>
#include <mutex>

namespace mote::lights {

using namespace core;

namespace {

constexpr std::size_t row_lanes = ReceiverLanes::width;
constexpr std::size_t lights_a_task = 1024;  // lights of a task
constexpr std::size_t sampled_lights = 2048;
constexpr double min_light = 0.05;  // of the mean of rows: darker ones are not made as bright as others
constexpr float max_value = 1e30f;  // squares of rows of it are finite in double precision
constexpr float min_column_norm = 1e-15f;  // columns below it have norms that single precision loses

float average_of(const LaneLight& l, std::size_t i) {
    return std::min((l.r[i] + l.g[i] + l.b[i]) * (1.0f / 3.0f), max_value);
}

/// Some lights at all rows: seen and unhidden, column after column.
struct Chunk {
    std::size_t first, count, stride;  ///< every stride-th light
    std::vector<float> seen, unhidden;

    Chunk(std::size_t first_, std::size_t count_, std::size_t stride_, std::size_t rows)
        : first(first_), count(count_), stride(stride_), seen(count_ * rows, 0.0f), unhidden(seen) {}
    std::size_t column(std::size_t light) const { return (light - first) / stride; }
};

/// Remembers the light before V*.
template <typename Visibility>
struct Unhidden {
    Visibility& visibility;
    std::span<float> values;  ///< of a chunk
    const Chunk& chunk;
    std::size_t rows, row;

    void operator()(std::span<ShadowPacket> packets, std::span<LaneLight> light) {
        for (const LaneLight& l : light)
            for (std::size_t i = 0; i < std::min(row_lanes, rows - row); ++i)
                values[chunk.column(l.vpl) * rows + row + i] = average_of(l, i);
        visibility(packets, light);
    }
};

struct MapVisibility {
    const RowMaps& maps;
    const VplSet& vpls;
    void operator()(std::span<ShadowPacket>, std::span<LaneLight> light) { maps.look_up(vpls, light); }
};

ReceiverTile tile_of(std::span<const PathReceiver> receivers) {
    ReceiverTile tile;
    tile.clear();
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        const PathReceiver& r = receivers[i];
        tile.set(int(i), r.vertex, r.throughput, r.state, Rng(), r.max_vpl_depth);
    }
    return tile;
}

class Rows {
  public:
    Rows(const RowContext& context, std::span<const PathReceiver> receivers, std::uint64_t key)
        : context_(context), rows_(receivers.size()), key_(key) {
        for (std::size_t first = 0; first < rows_; first += row_lanes)
            tiles_.push_back(tile_of(receivers.subspan(first, std::min(row_lanes, rows_ - first))));
        if (context.visibility.kind == RowVisibilitySettings::Kind::rays) return;
        maps_ = std::vector<RowMaps>(tiles_.size());
        for (std::size_t t = 0; t < tiles_.size(); ++t) {
            maps_[t].build(context.scene, tiles_[t], context.visibility, context.cancelled);
            context.rays.add(maps_[t].rays());
        }
    }

    void gather(Chunk& own) {
        const auto scratch = std::make_unique<GatherScratch>();
        RayCounters rays;
        TrackingCounters tracking;
        const GatherContext context{context_.scene, *scratch, rays, tracking, context_.cancelled};
        for (std::size_t t = 0; t < tiles_.size(); ++t) {
            context_.cancelled.check();
            ReceiverTile tile = tiles_[t];
            for (std::size_t i = 0; i < row_lanes; ++i) tile.rng[i] = Rng(hash_keys(key_, own.first, t, i));
            if (!maps_.empty()) {
                MapVisibility visibility{maps_[t], context_.vpls};
                gather_tile(own, t, tile, visibility, *scratch);
            } else {
                TracedVisibility visibility(context, tile);
                gather_tile(own, t, tile, visibility, *scratch);
            }
        }
        const std::lock_guard lock(mutex_);
        context_.rays.add(rays), context_.tracking.add(tracking);
    }

  private:
    template <typename Visibility>
    void gather_tile(Chunk& own, std::size_t t, const ReceiverTile& tile, Visibility& visibility,
                     GatherScratch& scratch) {
        Unhidden<Visibility> both{visibility, own.unhidden, own, rows_, t * row_lanes};
        const auto pairs = [&](const auto& visit) {
            for (std::size_t k = 0; k < own.count; ++k) visit(tile, WeightedVpl{own.first + k * own.stride});
        };
        gather_pairs(context_.vpls, pairs, BoundedGeometry{context_.bound}, both, scratch,
                     [&](const LaneLight& l) {
                         for (std::size_t i = 0; i < std::min(row_lanes, rows_ - t * row_lanes); ++i)
                             own.seen[own.column(l.vpl) * rows_ + t * row_lanes + i] = average_of(l, i);
                     });
    }

    const RowContext& context_;
    std::size_t rows_;
    std::uint64_t key_;
    std::vector<ReceiverTile> tiles_;
    std::vector<RowMaps> maps_;
    std::mutex mutex_;
};

double norm_of(std::span<const float> column) {
    double sum = 0.0;
    for (const float v : column) sum += double(v) * double(v);
    return std::sqrt(sum);
}

/// Factors of rows, so that each has about as much light as the others: one over that of some
/// lights. A receiver beside a light would decide alone what is alike.
std::vector<float> row_scales(Rows& rows, std::size_t lights, std::size_t count) {
    const std::size_t stride = std::max<std::size_t>(1, lights / sampled_lights);
    Chunk some(0, (lights + stride - 1) / stride, stride, count);
    rows.gather(some);
    std::vector<double> sums(count);
    double mean = 0.0;
    for (std::size_t i = 0; i < some.seen.size(); ++i) sums[i % count] += double(some.seen[i]);
    for (const double sum : sums) mean += sum / double(count);
    std::vector<float> scales(count, 1.0f);
    if (!(mean > 0.0)) return scales;
    for (std::size_t i = 0; i < count; ++i) scales[i] = float(1.0 / std::max(sums[i] / mean, min_light));
    return scales;
}

void scale_rows(std::span<float> values, std::span<const float> scales) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] *= scales[i % scales.size()];
}

/// Columns of a chunk into the matrix. Weights are norms so far.
void take(const Chunk& own, const VplSet& vpls, ReducedMatrix& matrix) {
    const std::size_t rows = matrix.rows;
    for (std::size_t k = 0; k < own.count; ++k) {
        const std::size_t j = own.first + k;
        const auto seen = std::span(own.seen).subspan(k * rows, rows);
        const auto unhidden = std::span(own.unhidden).subspan(k * rows, rows);
        const double s = norm_of(seen), u = norm_of(unhidden);
        matrix.weights[j] = float(std::min(s + double(hidden_factor) * u, 1e30));
        matrix.classes[j] = !(energy_of(vpls, j) > 0.0f) ? LightClass::none
                            : s > 0.0                    ? LightClass::lit
                            : u > 0.0                    ? LightClass::hidden
                                                         : LightClass::away;
        const auto column = std::span(matrix.values).subspan(j * rows, rows);
        for (std::size_t i = 0; i < rows; ++i) column[i] = s > 0.0 ? seen[i] : hidden_factor * unhidden[i];
    }
}

/// Values in units of the largest; columns that are nothing beside it are counted among those that are zero.
void normalise(ReducedMatrix& matrix) {
    float most = 0.0f;
    for (const float v : matrix.values) most = std::max(most, v);
    if (!(most > 0.0f)) return;
    for (float& v : matrix.values) v /= most;
    for (std::size_t j = 0; j < matrix.classes.size(); ++j) {
        matrix.weights[j] /= most;
        const auto column = std::span(matrix.values).subspan(j * matrix.rows, matrix.rows);
        if (matrix.classes[j] != LightClass::none && norm_of(column) < double(min_column_norm))
            matrix.classes[j] = LightClass::away;
    }
}

/// The defensive part: by energy at least.
void raise_weights(const VplSet& vpls, ReducedMatrix& matrix) {
    double weights = 0.0, energies = 0.0;
    for (std::size_t j = 0; j < matrix.weights.size(); ++j)
        weights += double(matrix.weights[j]), energies += double(energy_of(vpls, j));
    if (!(energies > 0.0)) return;
    const double factor = weights > 0.0 ? double(energy_fraction) * weights / energies : 1.0 / energies;
    for (std::size_t j = 0; j < matrix.weights.size(); ++j)
        matrix.weights[j] = std::max(matrix.weights[j], float(factor * double(energy_of(vpls, j))));
}

}  // namespace

float energy_of(const VplSet& vpls, std::size_t light) {
    const VirtualPointLight& vpl = vpls.lights[light];
    const float constant = vpl.detail == VirtualPointLight::no_detail ? 1.0f
                           : vpl.on_surface()                         ? inv_pi
                                                                      : inv_four_pi;
    return constant * average(vpl.intensity);
}

ReducedMatrix reduced_matrix(const RowContext& context, std::span<const PathReceiver> receivers,
                             std::uint64_t key) {
    const std::size_t lights = context.vpls.lights.size();
    ReducedMatrix matrix;
    matrix.rows = std::max<std::size_t>(receivers.size(), 1);  // without receivers a row of zeros
    matrix.values.resize(matrix.rows * lights), matrix.weights.resize(lights);
    matrix.classes.resize(lights);
    Rows rows(context, receivers, key);
    const auto scales = receivers.empty() || lights == 0 ? std::vector<float>(matrix.rows, 1.0f)
                                                         : row_scales(rows, lights, matrix.rows);
    tbb::parallel_for(std::size_t(0), (lights + lights_a_task - 1) / lights_a_task, [&](std::size_t c) {
        Chunk own(c * lights_a_task, std::min(lights_a_task, lights - c * lights_a_task), 1, matrix.rows);
        if (!receivers.empty()) rows.gather(own);
        scale_rows(own.seen, scales), scale_rows(own.unhidden, scales);
        take(own, context.vpls, matrix);
    });
    normalise(matrix);
    raise_weights(context.vpls, matrix);
    return matrix;
}

}  // namespace mote::lights
