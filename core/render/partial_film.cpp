#include "core/render/partial_film.h"

#include <algorithm>
#include <stdexcept>

#include "core/files/packed_numbers.h"
#include "core/files/whole_file.h"
#include "core/objects/error.h"
#include "core/render/headed_file.h"

namespace mote::core {

namespace {

constexpr FileKind partial_file{{'m', 'o', 't', 'e', 'p', 'a', 'r', 't'}, 3, "a partial film of mote"};
constexpr std::uint8_t kind_missing = 2;  ///< of a layer; 0: of the beauty, 1: auxiliary
constexpr std::uint32_t max_layers = 10000, max_edge = 1u << 20;

PartialFilm read_from(std::span<const std::byte> bytes) {
    HeadedFile file = read_headed_file(bytes, partial_file);
    ByteReader& reader = file.fields;
    std::string about = reader.text();
    const auto width = reader.number<std::uint32_t>(), height = reader.number<std::uint32_t>();
    const auto kept_bits = reader.number<std::uint8_t>();
    const auto count = reader.number<std::uint32_t>();
    if (width > max_edge || height > max_edge || count > max_layers)
        throw InputError("damaged (its size cannot be)");
    std::vector<Layer> layers;
    for (std::uint32_t i = 0; i < count; ++i) {
        Layer& layer = layers.emplace_back();
        layer.name = reader.text(), layer.description = reader.text();
        const auto kind = reader.number<std::uint8_t>();
        layer.auxiliary = kind != 0, layer.missing = kind == kind_missing;
        layer.squares = reader.number<std::uint8_t>() != 0;
        layer.where = reader.text(), layer.transport = read_transport(reader.text());
        layer.part = reader.number<std::uint32_t>(), layer.fine = reader.number<std::uint8_t>() != 0;
        if (layer.part >= count) throw InputError("damaged (a layer of no part)");
    }
    // Three channels a layer, three arrays of a sum: tested before memory is allocated that the file cannot
    // fill.
    const auto check_length = [&](std::uint64_t arrays, std::uint64_t numbers) {
        if (arrays * min_packed_size(numbers) > file.film.size())
            throw InputError("damaged (its length is wrong)");
    };
    const std::uint64_t pixels = std::uint64_t(width) * height;
    check_length(9 * std::uint64_t(count), pixels);
    try {
        const KeptSums kept = KeptSums::from_bits(kept_bits);
        const auto fine =
            std::ranges::count_if(layers, [&](const Layer& layer) { return keeps_fine(kept.split, layer); });
        check_length(9 * std::uint64_t(fine), 4 * pixels);
        PartialFilm partial{std::move(about),
                            Film(int(width), int(height), std::move(layers), kept.all_squares, kept.split)};
        partial.film.deserialize(file.film);
        return partial;
    } catch (const std::invalid_argument& error) {  // of the film's constructor
        throw InputError(std::string("damaged: ") + error.what());
    } catch (const InputError& error) {
        throw InputError(std::string("damaged: ") + error.what());
    }
}

}  // namespace

void write_partial_film(const std::string& path, const PartialFilm& partial) {
    const Film& film = partial.film;
    ByteWriter head;
    head.text(partial.about);
    head.number(std::uint32_t(film.width())), head.number(std::uint32_t(film.height()));
    head.number(std::uint8_t(film.kept().bits()));
    head.number(std::uint32_t(film.layers().size()));
    for (const Layer& layer : film.layers()) {
        head.text(layer.name), head.text(layer.description);
        head.number(std::uint8_t(layer.missing ? kind_missing : layer.auxiliary)),
            head.number(std::uint8_t(layer.squares));
        head.text(layer.where), head.text(transport_name(layer.transport));
        head.number(std::uint32_t(layer.part)), head.number(std::uint8_t(layer.fine));
    }
    write_headed_file(path, partial_file, head, film.serialize());
}

bool is_partial_film(const std::string& path) {
    std::vector<std::byte> beginning;
    return read_head(path, partial_file, beginning).has_value();
}

PartialFilm read_partial_film(const std::string& path) {
    const std::vector<std::byte> bytes = read_whole_file(path);
    try {
        return read_from(bytes);
    } catch (const InputError& error) {
        throw InputError(std::string("this file is ") + error.what(), {path, 0});
    }
}

}  // namespace mote::core
