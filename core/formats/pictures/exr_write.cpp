// Layered OpenEXR files out: scan lines, ZIP, float32 or half, metadata as string attributes.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "core/files/atomic_file.h"
#include "core/formats/pictures/channel_order.h"
#include "core/formats/pictures/image_file.h"
#include "core/objects/error.h"

namespace mote::core {

namespace {

// Encodes into memory, so that one function writes all files and sees all errors of the system.
class MemoryStream final : public Imf::OStream {
  public:
    MemoryStream() : Imf::OStream("memory") {}
    void write(const char c[], int n) override {
        const auto size = std::size_t(n);
        if (position_ + size > bytes_.size()) bytes_.resize(position_ + size);
        std::memcpy(bytes_.data() + position_, c, size);
        position_ += size;
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override { position_ = std::size_t(position); }
    std::span<const std::byte> bytes() const { return bytes_; }

  private:
    std::vector<std::byte> bytes_;
    std::size_t position_ = 0;
};

// Distances and positions need more than eleven bits.
bool needs_float(const std::string& name) {
    return name == "Depth.Z" || name.starts_with("P.") || name.starts_with("PreviousP.") ||
           name.ends_with("Id.Y");
}

constexpr float largest_half = 65504.0f;

// A finite value too large for a half becomes the largest half: infinity would be a lie.
half to_half(float value) {
    return half(std::isfinite(value) ? std::clamp(value, -largest_half, largest_half) : value);
}

// 16 numbers, row by row, in OpenEXR's convention of row vectors.
bool insert_matrix(Imf::Header& header, const std::string& name, const std::string& text) {
    if (name != "worldToCamera") return false;
    std::istringstream numbers(text);
    Imath::M44f m;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            if (!(numbers >> m[row][column])) return false;
    header.insert(name, Imf::M44fAttribute(m));
    return true;
}

Imf::Header make_header(const ImageChannels& image, bool use_half) {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    header.zipCompressionLevel() = 2;  // hardly larger than the default 4, and a Ctrl-C waits for it
    for (const std::string& name : image.names)
        header.channels().insert(name, Imf::Channel(use_half && !needs_float(name) ? Imf::HALF : Imf::FLOAT));
    std::string order;
    for (const std::string& name : image.names) order += (order.empty() ? "" : " ") + name;
    header.insert(channel_order, Imf::StringAttribute(order));
    for (const auto& [name, text] : image.metadata)
        if (!insert_matrix(header, name, text)) header.insert(name, Imf::StringAttribute(text));
    return header;
}

/// The library compresses by the threads of its pool, which is empty until someone fills it.
void fill_pool(int threads) {
    try {
        if (Imf::globalThreadCount() == 0) Imf::setGlobalThreadCount(threads);
    } catch (const std::system_error&) {  // no more threads: it writes by this one
    }
}

std::uint64_t encode(MemoryStream& stream, const ImageChannels& image, bool use_half) {
    const Imf::Header header = make_header(image, use_half);
    const auto width = std::size_t(image.width), pixels = width * std::size_t(image.height);
    std::vector<std::vector<half>> halves;
    halves.reserve(image.names.size());
    std::uint64_t clamped = 0;
    Imf::FrameBuffer frame;
    for (std::size_t i = 0; i < image.names.size(); ++i) {
        const std::vector<float>& plane = image.channels[i];
        if (plane.size() != pixels) throw std::invalid_argument("a plane does not fit the picture");
        if (header.channels().findChannel(image.names[i])->type == Imf::HALF) {
            std::vector<half>& h = halves.emplace_back(pixels);
            std::transform(plane.begin(), plane.end(), h.begin(), to_half);
            clamped += std::uint64_t(std::count_if(plane.begin(), plane.end(), [](float v) {
                return std::isfinite(v) && std::fabs(v) > largest_half;
            }));
            frame.insert(image.names[i], Imf::Slice(Imf::HALF, reinterpret_cast<char*>(h.data()),
                                                    sizeof(half), sizeof(half) * width));
        } else {
            // The library reads from the slices alone; its type just has no const.
            char* base = reinterpret_cast<char*>(const_cast<float*>(plane.data()));
            frame.insert(image.names[i], Imf::Slice(Imf::FLOAT, base, sizeof(float), sizeof(float) * width));
        }
    }
    const int threads = int(std::clamp(std::thread::hardware_concurrency(), 1u, 16u));
    fill_pool(threads);
    Imf::OutputFile file(stream, header, threads);
    file.setFrameBuffer(frame);
    file.writePixels(image.height);
    return clamped;
}

}  // namespace

std::uint64_t write_exr(const std::string& path, const ImageChannels& image, bool half) {
    if (image.width < 1 || image.height < 1 || image.names.size() != image.channels.size())
        throw std::invalid_argument("a picture without pixels, or with nameless channels");
    MemoryStream stream;
    std::uint64_t clamped = 0;
    try {
        clamped = encode(stream, image, half);
    } catch (const Iex::BaseExc& error) {
        throw InputError(std::string("cannot be written: ") + printable(error.what()), {path, 0});
    }
    write_file_atomically(path, stream.bytes());
    return clamped;
}

}  // namespace mote::core
