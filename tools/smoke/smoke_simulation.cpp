#include "tools/smoke/smoke_simulation.h"

#include <tbb/parallel_reduce.h>

#include <algorithm>

namespace mote::tools {

using core::Vec3;

namespace {

constexpr int pressure_cycles = 2;  // each V-cycle removes about nine tenths of the divergence

Vec3 cell_centre(int i, int j, int k) { return {float(i) + 0.5f, float(j) + 0.5f, float(k) + 0.5f}; }

/// 1 inside, 0 outside, smooth over the outer half.
float soft_ball(float distance, float radius) {
    const float t = glm::clamp(2.0f * (1.0f - distance / radius), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

}  // namespace

SmokeSimulation::SmokeSimulation(const SmokeSettings& settings)
    : settings_(settings),
      size_(settings.size),
      noise_(settings.seed),
      solver_(settings.size, settings.sides),
      flow_(size_.cells(), Flow(0.0f)),
      predicted_flow_(size_.cells()),
      next_flow_(size_.cells()),
      density_(size_.cells(), 0.0f),
      predicted_density_(size_.cells()),
      next_density_(size_.cells()),
      vorticity_(size_.cells()),
      displacement_(size_.cells()),
      divergence_(size_.cells()),
      pressure_(size_.cells(), 0.0f) {
    fill_with_haze();
}

void SmokeSimulation::step() {
    emit();
    add_forces();
    project();
    advect();
    time_ += settings_.time_step;
}

void SmokeSimulation::fill_with_haze() {
    if (settings_.haze <= 0.0f) return;
    for_each_row(size_, [&](int j, int k) {
        for (int i = 0; i < size_.x; ++i) {
            // Layers: features are wider than high, as in air that has come to rest.
            const Vec3 p = cell_centre(i, j, k) * settings_.cell * Vec3(1.2f, 3.0f, 1.2f);
            const float n = noise_.fractal(p, 4);
            density_[size_.index(i, j, k)] = settings_.haze * std::max(0.0f, 1.0f + 1.6f * n);
        }
    });
}

void SmokeSimulation::emit() {
    const Vec3 box(float(size_.x), float(size_.y), float(size_.z));
    const Vec3 centre = settings_.source * box;
    const float radius = settings_.source_radius / settings_.cell;
    const Vec3 drift(0.0f, -2.0f * time_, 0.3f * time_);
    for_each_row(size_, [&](int j, int k) {
        for (int i = 0; i < size_.x; ++i) {
            const Vec3 p = cell_centre(i, j, k);
            const float ball = soft_ball(glm::length(p - centre), radius);
            if (ball <= 0.0f) continue;
            const Vec3 q = (p - centre) / radius * 1.7f + drift * 2.5f;
            const float strength = ball * glm::clamp(0.75f + 0.9f * noise_.fractal(q, 3), 0.0f, 1.0f);
            const std::size_t c = size_.index(i, j, k);
            density_[c] = std::max(density_[c], strength);
            flow_[c].w = std::max(flow_[c].w, strength * settings_.source_temperature);
            const Vec3 push = noise_.vector_at(q * 0.8f + Vec3(9.0f)) * settings_.jitter * ball;
            flow_[c] += Flow(push * settings_.time_step, 0.0f);
        }
    });
}

// Fedkiw, Stam and Jensen 2001, Eqs. 8 to 11: buoyancy, and confinement eps * h * (N x omega), where N points
// to where the air turns faster.
void SmokeSimulation::add_forces() {
    find_vorticity();
    const float dt = settings_.time_step, h = settings_.cell;
    for_each_row(size_, [&](int j, int k) {
        const bool inner_row = j > 0 && j + 1 < size_.y && k > 0 && k + 1 < size_.z;
        const std::size_t row = std::size_t(size_.x), slice = row * std::size_t(size_.y);
        for (int i = 0; i < size_.x; ++i) {
            const std::size_t c = size_.index(i, j, k);
            flow_[c].y += dt * settings_.buoyancy * flow_[c].w;
            if (!inner_row || i == 0 || i + 1 == size_.x) continue;
            const Vec3 slope =
                Vec3(vorticity_[c + 1].w - vorticity_[c - 1].w, vorticity_[c + row].w - vorticity_[c - row].w,
                     vorticity_[c + slice].w - vorticity_[c - slice].w) *
                (0.5f / h);
            const float length = glm::length(slope);
            if (length < 1e-4f) continue;  // no direction: the force would be noise
            const Vec3 force = settings_.confinement * h * glm::cross(slope / length, Vec3(vorticity_[c]));
            flow_[c] += Flow(force * dt, 0.0f);
        }
    });
}

void SmokeSimulation::find_vorticity() {
    const float scale = 0.5f / settings_.cell;
    const std::size_t row = std::size_t(size_.x), slice = row * std::size_t(size_.y);
    for_each_row(size_, [&](int j, int k) {
        const bool inner_row = j > 0 && j + 1 < size_.y && k > 0 && k + 1 < size_.z;
        for (int i = 0; i < size_.x; ++i) {
            const std::size_t c = size_.index(i, j, k);
            if (!inner_row || i == 0 || i + 1 == size_.x) {
                vorticity_[c] = Flow(0.0f);
                continue;
            }
            const Vec3 dx = Vec3(flow_[c + 1] - flow_[c - 1]);
            const Vec3 dy = Vec3(flow_[c + row] - flow_[c - row]);
            const Vec3 dz = Vec3(flow_[c + slice] - flow_[c - slice]);
            const Vec3 curl = scale * Vec3(dy.z - dz.y, dz.x - dx.z, dx.y - dy.x);
            vorticity_[c] = Flow(curl, glm::length(curl));
        }
    });
}

// The divergence of the velocities at the faces, which are means of the two cells beside them. Nothing passes
// a wall; through an open side air leaves as fast as it arrives there.
void SmokeSimulation::find_divergence() {
    const int n[3] = {size_.x, size_.y, size_.z};
    const std::size_t stride[3] = {1, std::size_t(size_.x), std::size_t(size_.x) * std::size_t(size_.y)};
    for_each_row(size_, [&](int j, int k) {
        for (int i = 0; i < size_.x; ++i) {
            const std::size_t c = size_.index(i, j, k);
            const int at[3] = {i, j, k};
            float sum = 0.0f;
            for (int a = 0; a < 3; ++a) {
                const float u = flow_[c][a];
                const auto border = [&](bool upper) { return settings_.sides.open(a, upper) ? u : 0.0f; };
                sum += at[a] + 1 < n[a] ? 0.5f * (u + flow_[c + stride[a]][a]) : border(true);
                sum -= at[a] > 0 ? 0.5f * (u + flow_[c - stride[a]][a]) : border(false);
            }
            divergence_[c] = sum;
        }
    });
}

// The mean of the gradients at the two faces; zero at walls, towards pressure zero at open sides.
Vec3 SmokeSimulation::pressure_gradient(int i, int j, int k) const {
    const int n[3] = {size_.x, size_.y, size_.z};
    const std::size_t stride[3] = {1, std::size_t(size_.x), std::size_t(size_.x) * std::size_t(size_.y)};
    const std::size_t c = size_.index(i, j, k);
    const int at[3] = {i, j, k};
    Vec3 gradient(0.0f);
    for (int a = 0; a < 3; ++a) {
        const float p = pressure_[c];
        const auto border = [&](bool upper) { return settings_.sides.open(a, upper) ? p : 0.0f; };
        const float above = at[a] + 1 < n[a] ? pressure_[c + stride[a]] - p : -border(true);
        const float below = at[a] > 0 ? p - pressure_[c - stride[a]] : border(false);
        gradient[a] = 0.5f * (above + below);
    }
    return gradient;
}

void SmokeSimulation::project() {
    find_divergence();
    solver_.solve(pressure_, divergence_, pressure_cycles);
    for_each_row(size_, [&](int j, int k) {
        for (int i = 0; i < size_.x; ++i)
            flow_[size_.index(i, j, k)] -= Flow(pressure_gradient(i, j, k), 0.0f);
    });
}

// How far the air in a cell moves in one step, in cells: by the velocity half a step back (midpoint rule).
Vec3 SmokeSimulation::displacement(int i, int j, int k) const {
    const float scale = settings_.time_step / settings_.cell;
    const Vec3 half = Vec3(flow_[size_.index(i, j, k)]) * (0.5f * scale);
    return Vec3(Stencil(size_, cell_centre(i, j, k) - half).gather(flow_)) * scale;
}

// MacCormack (Selle et al. 2008, Section 3): carry everything along, carry it back, and take away half of
// what the round trip changed.
void SmokeSimulation::advect() {
    for_each_row(size_, [&](int j, int k) {
        for (int i = 0; i < size_.x; ++i) {
            const std::size_t c = size_.index(i, j, k);
            const Vec3 moved = displacement(i, j, k);
            const Stencil from(size_, cell_centre(i, j, k) - moved);
            displacement_[c] = moved;
            predicted_flow_[c] = from.gather(flow_);
            predicted_density_[c] = from.gather(density_);
        }
    });
    const float kept = std::exp(-settings_.cooling * settings_.time_step);
    for_each_row(size_, [&](int j, int k) {
        for (int i = 0; i < size_.x; ++i) correct(i, j, k, kept);
    });
    flow_.swap(next_flow_);
    density_.swap(next_density_);
}

// Values that leave the range of the cells they came from fall back to plain transport, which never does.
void SmokeSimulation::correct(int i, int j, int k, float kept_heat) {
    const std::size_t c = size_.index(i, j, k);
    const Vec3 p = cell_centre(i, j, k);
    const Stencil from(size_, p - displacement_[c]), back(size_, p + displacement_[c]);
    Flow low, high;
    float thin, thick;
    from.range(
        flow_, low, high, [](const Flow& a, const Flow& b) { return glm::min(a, b); },
        [](const Flow& a, const Flow& b) { return glm::max(a, b); });
    from.range(
        density_, thin, thick, [](float a, float b) { return std::min(a, b); },
        [](float a, float b) { return std::max(a, b); });
    const Flow flow = predicted_flow_[c] + 0.5f * (flow_[c] - back.gather(predicted_flow_));
    const float smoke = predicted_density_[c] + 0.5f * (density_[c] - back.gather(predicted_density_));
    for (int a = 0; a < 4; ++a)
        next_flow_[c][a] = flow[a] < low[a] || flow[a] > high[a] ? predicted_flow_[c][a] : flow[a];
    next_flow_[c].w *= kept_heat;
    next_density_[c] = smoke < thin || smoke > thick ? predicted_density_[c] : smoke;
}

double SmokeSimulation::divergence_norm() {
    find_divergence();
    double sum = 0.0;
    for (const float d : divergence_) sum += double(d) * double(d);
    return std::sqrt(sum / double(size_.cells())) / double(settings_.cell);
}

float SmokeSimulation::max_speed() const {
    float fastest = 0.0f;
    for (const Flow& f : flow_) fastest = std::max(fastest, glm::length(Vec3(f)));
    return fastest;
}

}  // namespace mote::tools
