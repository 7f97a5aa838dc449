#include "experiments/benchmarks/smoke_grid.h"

#include <nanovdb/util/GridBuilder.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace mote::benchmarks {
namespace {

constexpr int half_x = 64, half_y = 128;
constexpr double voxel_size = 1.0 / 128.0;

/// Density of a plume that winds upwards and widens, with detail at several sizes; zero outside.
float density(int x, int y, int z) {
    const float up = (float(y) + half_y) / (2.0f * half_y);
    const float center_x = 12.0f * std::sin(9.0f * up), center_z = 12.0f * std::cos(7.0f * up);
    const float radius = 12.0f + 34.0f * up;
    float detail = 0.0f, amplitude = 0.5f;
    for (float f = 0.05f; f < 1.0f; f *= 2.1f, amplitude *= 0.6f)
        detail += amplitude * std::sin(f * float(x) + 1.0f) * std::sin(f * float(y) + 2.0f) *
                  std::sin(f * float(z) + 3.0f);
    const float r = std::hypot(float(x) - center_x, float(z) - center_z) / radius;
    return std::max(0.0f, 1.0f - r * r + detail);
}

}  // namespace

std::shared_ptr<const media::VdbGrid> make_smoke_grid() {
    nanovdb::GridBuilder<float> builder(0.0f, nanovdb::GridClass::FogVolume);
    auto accessor = builder.getAccessor();
    auto data = std::make_unique<media::VdbGrid::Data>();
    data->lower = media::Voxel(half_y), data->upper = media::Voxel(-half_y);
    for (int x = -half_x; x < half_x; ++x)
        for (int y = -half_y; y < half_y; ++y)
            for (int z = -half_x; z < half_x; ++z) {
                const float v = density(x, y, z);
                if (v <= 0.0f) continue;
                accessor.setValue({x, y, z}, v);
                const media::Voxel at(x, y, z);
                data->lower = glm::min(data->lower, at), data->upper = glm::max(data->upper, at);
                data->max_value = std::max(data->max_value, v);
                ++data->active_voxels;
            }
    const auto handle = builder.getHandle<>();
    data->buffer = media::AlignedBuffer(handle.size());
    std::memcpy(data->buffer.data(), handle.data(), handle.size());
    data->grid = media::checked_nano_grid(data->buffer, "<smoke made in code>");
    data->name = "density", data->uniform = false;
    data->index_to_world.matrix = glm::scale(glm::dmat4(1.0), core::Vec3d(voxel_size));
    return std::make_shared<media::VdbGrid>(std::move(data));
}

}  // namespace mote::benchmarks
