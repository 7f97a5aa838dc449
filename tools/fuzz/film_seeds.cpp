// Films: checkpoints and the partial films of `mote render --pass-range`, and their checksums.
#include <cstring>
#include <span>

#include "core/files/checksum.h"
#include "core/render/checkpoint.h"
#include "core/render/partial_film.h"
#include "tools/fuzz/scratch_file.h"
#include "tools/fuzz/seeds.h"

namespace mote::fuzz {

namespace {

core::Film with_passes(core::Film film, std::uint32_t first, std::uint32_t end) {
    film.begin_at(0, first);
    core::PassImage image(4, 3, 2);
    for (std::size_t i = 0; i < 12; ++i) image.layer(0)[i] = core::Rgb(0.1f * float(i), 0.3f, 1e-3f);
    for (std::uint32_t pass = first; pass < end; ++pass) film.add_pass(image);
    return film;
}
core::Film film_of(std::uint32_t first, std::uint32_t end) { return with_passes(small_film(), first, end); }

/// A checkpoint with control passes.
Bytes checkpoint_with_controls() {
    const ScratchFile file(".checkpoint");
    const core::Film film = with_passes(small_film(core::PassSplit::halves), 0, 5);
    core::ControlPasses controls(film);
    controls.choose(film, 7);
    const core::PixelColumns& columns = controls.columns();
    core::PassImage image(columns.columns(), columns.rows(), 1);
    for (core::Rgb& light : image.layer(0)) light = core::Rgb(0.5f, 0.3f, 0.1f);
    for (int pass = 0; pass < 5; ++pass) controls.add_pass(image, 0);
    core::write_checkpoint(file.path(), {checkpoint_hash, 7}, film, {}, controls);
    return file.bytes();
}

}  // namespace

core::Film small_film(core::PassSplit split) {
    return core::Film(4, 3, {core::Layer{"direct", ""}, core::Layer{"indirect", ""}}, false, split);
}

std::vector<Bytes> checkpoint_seeds() {
    const ScratchFile file(".checkpoint");
    std::vector<Bytes> seeds;
    for (const std::uint32_t passes : {1u, 16u, 17u}) {
        core::write_checkpoint(file.path(), {checkpoint_hash, 7}, film_of(0, passes));
        seeds.push_back(file.bytes());
    }
    seeds.push_back(checkpoint_with_controls());
    return seeds;
}

Bytes partial_film(std::uint32_t first, std::uint32_t end) {
    const std::string passes = "[" + std::to_string(first) + "," + std::to_string(end) + "]";
    const std::string about =
        R"({"mote":"0.1.0","commit":"0123456789ab","scene":"scene.xml","requested_integrator":"","defines":["a=1"],)"
        R"("lenient":false,"auxiliary":false,"denoise":"","half":false,"seed":7,"integrator":"path",)"
        R"("content":"0123456789abcdef","passes":)" +
        passes +
        R"(,"statistics":{"rays":{"closest":12},"lookups":{},"seconds":{"render":0.5},"values":{"noise":0.1},)"
        R"("warnings":[],"non_finite_samples":0,"clamped":0}})";
    const ScratchFile file(".film");
    core::write_partial_film(file.path(), {about, film_of(first, end)});
    return file.bytes();
}

std::vector<Bytes> partial_film_seeds() {
    return {partial_film(0, 5), partial_film(2, 5), partial_film(4, 5)};
}

void forge_checkpoint(Bytes& bytes) {
    constexpr std::size_t size_at = 12, number = sizeof(std::uint64_t);
    if (bytes.size() < size_at + 4 + number) return;
    const auto sum = [&](std::size_t begin, std::size_t end) {
        const std::uint64_t value =
            core::checksum(std::as_bytes(std::span(bytes).subspan(begin, end - begin)));
        std::memcpy(bytes.data() + end, &value, number);
    };
    std::uint32_t head = 0;
    std::memcpy(&head, bytes.data() + size_at, sizeof(head));
    if (head > bytes.size() || bytes.size() - head < number) return;
    sum(0, head);
    if (bytes.size() >= head + 2 * number) sum(head + number, bytes.size() - number);
}

}  // namespace mote::fuzz
