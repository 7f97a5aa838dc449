// OpenEXR files in: scan lines or tiles, any channel type, sub-sampled channels, the largest level.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <map>
#include <new>
#include <numeric>
#include <sstream>

#include "core/formats/pictures/channel_order.h"
#include "core/formats/pictures/exr_preflight.h"
#include "core/formats/pictures/image_file.h"
#include "core/objects/error.h"

namespace mote::core {

namespace {

std::string matrix_text(const Imath::M44f& m) {
    std::ostringstream text;
    text.precision(9);
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) text << (row + column > 0 ? " " : "") << m[row][column];
    return text.str();
}

std::map<std::string, std::string> read_metadata(const Imf::Header& header) {
    std::map<std::string, std::string> metadata;
    for (auto a = header.begin(); a != header.end(); ++a) {
        const Imf::Attribute& attribute = a.attribute();
        if (const auto* s = dynamic_cast<const Imf::StringAttribute*>(&attribute))
            metadata[a.name()] = s->value();
        else if (const auto* f = dynamic_cast<const Imf::FloatAttribute*>(&attribute))
            metadata[a.name()] = std::to_string(f->value());
        else if (const auto* i = dynamic_cast<const Imf::IntAttribute*>(&attribute))
            metadata[a.name()] = std::to_string(i->value());
        else if (const auto* m = dynamic_cast<const Imf::M44fAttribute*>(&attribute))
            metadata[a.name()] = matrix_text(m->value());
    }
    return metadata;
}

// Spreads a channel that was stored for every xs-th pixel of every ys-th line over all pixels.
std::vector<float> spread(const std::vector<float>& sparse, int width, int height, int xs, int ys) {
    const int columns = width / xs;
    std::vector<float> plane(std::size_t(width) * std::size_t(height));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            plane[std::size_t(y) * std::size_t(width) + std::size_t(x)] =
                sparse[std::size_t(y / ys) * std::size_t(columns) +
                       std::size_t(std::min(x / xs, columns - 1))];
    return plane;
}

ImageChannels decode(const std::string& path, const ExrSummary& summary) {
    Imf::MultiPartInputFile file(path.c_str(), 0);
    Imf::InputPart part(file, summary.part);
    const Imf::Header& header = part.header();
    const Imath::Box2i window = header.dataWindow();

    ImageChannels image;
    image.width = window.max.x - window.min.x + 1, image.height = window.max.y - window.min.y + 1;
    image.metadata = read_metadata(header);
    Imf::FrameBuffer frame;
    std::vector<std::pair<int, int>> sampling;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
        const int xs = c.channel().xSampling, ys = c.channel().ySampling;
        const int columns = image.width / xs, rows = image.height / ys;
        if (columns < 1 || rows < 1) throw InputError("damaged OpenEXR file: sparse channel without pixels");
        image.names.emplace_back(c.name());
        std::vector<float>& plane =
            image.channels.emplace_back(std::size_t(columns) * std::size_t(rows), 0.0f);
        sampling.emplace_back(xs, ys);
        frame.insert(c.name(), Imf::Slice::Make(Imf::FLOAT, plane.data(), window, sizeof(float),
                                                sizeof(float) * std::size_t(columns), xs, ys));
    }
    part.setFrameBuffer(frame);
    part.readPixels(window.min.y, window.max.y);
    for (std::size_t i = 0; i < sampling.size(); ++i)
        if (const auto [xs, ys] = sampling[i]; xs > 1 || ys > 1)
            image.channels[i] = spread(image.channels[i], image.width, image.height, xs, ys);
    return image;
}

/// The order that the picture had when it was written; channels of others come last.
void restore_order(ImageChannels& image) {
    const auto found = image.metadata.find(channel_order);
    if (found == image.metadata.end()) return;
    std::map<std::string, std::size_t> places;
    std::istringstream names(found->second);
    for (std::string name; names >> name;) places.try_emplace(name, places.size());
    std::vector<std::size_t> order(image.names.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    const auto place = [&](std::size_t i) {
        const auto at = places.find(image.names[i]);
        return at == places.end() ? places.size() : at->second;
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
    ImageChannels sorted{image.width, image.height, {}, {}, std::move(image.metadata)};
    for (const std::size_t i : order) sorted.add(image.names[i], std::move(image.channels[i]));
    sorted.metadata.erase(channel_order);
    image = std::move(sorted);
}

/// Converts exceptions of the library to an InputError that names the file once.
template <typename Read>
auto with_clear_errors(const std::string& path, const Read& read) {
    try {
        return read();
    } catch (const InputError& error) {
        throw InputError(error.what(), {path, 0});
    } catch (const std::bad_alloc&) {
        throw InputError("OpenEXR file needs more memory than there is", {path, 0});
    } catch (const std::exception& error) {
        // The library repeats the file's name, once for every level it passes through.
        std::string message = error.what();
        const std::string prefix = "\"" + path + "\". ";
        if (const auto at = message.rfind(prefix); at != std::string::npos)
            message.erase(0, at + prefix.size());
        throw InputError("damaged OpenEXR file: " + printable(message), {path, 0});
    }
}

}  // namespace

ImageChannels read_exr(const std::string& path) {
    const ExrSummary summary = check_exr_header(path);
    return with_clear_errors(path, [&] {
        ImageChannels image = decode(path, summary);
        restore_order(image);
        return image;
    });
}

std::map<std::string, std::string> read_exr_metadata(const std::string& path) {
    const ExrSummary summary = check_exr_header(path);
    return with_clear_errors(path, [&] {
        Imf::MultiPartInputFile file(path.c_str(), 0);
        auto metadata = read_metadata(Imf::InputPart(file, summary.part).header());
        metadata.erase(channel_order);
        return metadata;
    });
}

}  // namespace mote::core
