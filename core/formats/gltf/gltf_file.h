// A glTF 2.0 file: its JSON document, and the bytes of its buffers and pictures, wherever they are: in the
// file itself (.glb), beside it, or in the text (base64).
//
// Our own reader, as for OBJ and PLY: the document must be read for what assimp 5.2 leaves out (emissive
// strength, which extensions are used), and two readers of one file would have to agree on what is what.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/formats/gltf/gltf_value.h"

namespace mote::core {

class GltfFile {
  public:
    /// Throws InputError for a file that is damaged, of another version, or larger than 64 levels deep.
    explicit GltfFile(const std::string& path);
    ~GltfFile();
    GltfFile(const GltfFile&) = delete;
    GltfFile& operator=(const GltfFile&) = delete;

    const std::string& path() const { return path_; }
    GltfValue root() const { return {json_.get(), "", path_}; }
    /// The bytes of bufferViews[i], as long as this lives.
    std::span<const std::byte> view(std::size_t i);

    /// A picture: a file beside the scene, or bytes.
    struct Image {
        std::string path;                  ///< "" where it is in the file
        std::span<const std::byte> bytes;  ///< as long as the GltfFile lives
    };
    Image image(std::size_t i);

    /// The file and what was read beside it, in order.
    const std::vector<std::string>& files() const { return files_; }

  private:
    void parse(std::span<const std::byte> text);
    void open_binary();
    const std::vector<std::byte>& buffer(std::size_t i);
    std::vector<std::byte> read_buffer(const GltfValue& value, bool first);
    std::string beside(const GltfValue& uri);

    std::string path_;
    std::vector<std::byte> whole_;
    std::span<const std::byte> binary_chunk_;
    std::unique_ptr<nlohmann::json> json_;
    std::map<std::size_t, std::vector<std::byte>> buffers_, data_uris_;
    std::vector<std::string> files_;
};

}  // namespace mote::core
