// Epipolar sampling of a host's depth buffer (screenspace/epipolar/depth_buffer.h).
#include "plugins/c/handles.h"
#include "screenspace/epipolar/depth_buffer.h"

using namespace mote;
using c::required;

namespace {

screenspace::DepthBuffer depth_buffer(const mote_epipolar_options& o) {
    if (o.width < 1 || o.height < 1 || o.lines < 0 || o.samples < 0 || o.samples == 1 ||
        !(o.tolerance >= 0.0) || !o.depth || !o.march)
        throw c::InvalidArgument(
            "a size, a focal length, a far distance, a depth buffer and march() are needed");
    screenspace::DepthBuffer buffer;
    buffer.width = o.width, buffer.height = o.height;
    buffer.depth = {o.depth, std::size_t(o.width) * std::size_t(o.height)};
    buffer.far_distance = o.far_distance, buffer.focal_length = o.focal_length;
    buffer.centre = {o.centre_x, o.centre_y};
    if (o.centre_x == 0.0 && o.centre_y == 0.0) buffer.centre = {0.5 * o.width, 0.5 * o.height};
    buffer.lamp = {o.lamp[0], o.lamp[1], o.lamp[2]};
    return buffer;
}

}  // namespace

mote_status mote_epipolar(const mote_epipolar_options* given, float* light, size_t count, uint64_t* marched) {
    bool too_small = false;
    c::LastError unheard;
    const mote_status status = c::guarded(unheard, [&] {
        const mote_epipolar_options o = c::known_options(&required(given, "the options"));
        const screenspace::DepthBuffer buffer = depth_buffer(o);
        too_small = count < 3 * buffer.depth.size();
        if (too_small) throw c::InvalidArgument("the buffer is too small");
        float* to = &required(light, "the buffer");

        screenspace::LineSampling sampling;
        if (o.samples > 0) sampling.initial = o.samples;
        if (o.tolerance > 0.0) sampling.tolerance = float(o.tolerance);
        const auto march = [&o](const screenspace::Vec2d& film, double distance) {
            float radiance[3] = {0.0f, 0.0f, 0.0f};
            o.march(o.user, film.x, film.y, distance, radiance);
            return core::Rgb(radiance[0], radiance[1], radiance[2]);
        };
        const auto found = screenspace::light_over(buffer, o.lines > 0 ? o.lines : 512, sampling, march);
        for (std::size_t i = 0; i < found.light.size(); ++i)
            for (int c = 0; c < 3; ++c) to[3 * i + std::size_t(c)] = found.light[i][c];
        if (marched) *marched = found.marched;
    });
    return too_small ? MOTE_BUFFER_TOO_SMALL : status;
}
