// Upsampling and visibility queries over a host's arrays of pixels.
#include "plugins/c/handles.h"
#include "screenspace/upsampling/upsampled_picture.h"
#include "screenspace/visibility/exact_counts.h"

using namespace mote;
using c::required;
using core::Rgb, core::Vec3;

namespace {

std::vector<Vec3> triples(const float* values, std::size_t count) {
    std::vector<Vec3> result(count);
    for (std::size_t i = 0; i < count; ++i) result[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
    return result;
}

}  // namespace

mote_status mote_upsample(const mote_upsample_options* given, float* light, size_t count, uint64_t* shaded) {
    bool too_small = false;
    c::LastError unheard;
    const mote_status status = c::guarded(unheard, [&] {
        const mote_upsample_options o = c::known_options(&required(given, "the options"));
        if (o.width < 1 || o.height < 1 || !o.position || !o.normal || !o.shade)
            throw c::InvalidArgument("a size, positions, normals and shade() are needed");
        const std::size_t pixels = std::size_t(o.width) * std::size_t(o.height);
        too_small = count < 3 * pixels;
        if (too_small) throw c::InvalidArgument("the buffer is too small");
        float* to = &required(light, "the buffer");

        const std::vector<Vec3> position = triples(o.position, pixels), normal = triples(o.normal, pixels);
        std::vector<Rgb> albedo;
        if (o.albedo) albedo = triples(o.albedo, pixels);
        const auto found = screenspace::upsampled(
            {o.width, o.height, o.focal_length, position, normal, albedo}, o.spacing, [&o](int x, int y) {
                float radiance[3] = {0.0f, 0.0f, 0.0f};
                o.shade(o.user, x, y, radiance);
                return Rgb(radiance[0], radiance[1], radiance[2]);
            });
        for (std::size_t i = 0; i < pixels; ++i)
            for (int c = 0; c < 3; ++c) to[3 * i + std::size_t(c)] = found.light[i][c];
        if (shaded) *shaded = found.shaded;
    });
    return too_small ? MOTE_BUFFER_TOO_SMALL : status;
}

mote_status mote_count_visible(const uint32_t* items, int width, int height, uint32_t item_count,
                               const mote_visibility_query* queries, size_t query_count, uint32_t* pixels) {
    c::LastError unheard;
    return c::guarded(unheard, [&] {
        if (width < 1 || height < 1) throw c::InvalidArgument("a picture has pixels");
        const screenspace::IdPicture picture{
            width, height, {&required(items, "the items"), std::size_t(width) * std::size_t(height)}};
        for (const std::uint32_t item : picture.items)
            if (item >= item_count && item != MOTE_NO_ITEM)
                throw c::InvalidArgument("the picture shows an item that there is none of");
        const screenspace::ExactCounts counts(picture, item_count);
        for (std::size_t i = 0; i < query_count; ++i) {
            const mote_visibility_query& q = (&required(queries, "the queries"))[i];
            if (q.item >= item_count) throw c::InvalidArgument("there is no such item");
            (&required(pixels, "the counts"))[i] = counts.pixels({q.item, {q.x0, q.y0, q.x1, q.y1}});
        }
    });
}
