// Textures of glTF materials as textures of ours: pictures as they are where they can be, else new ones, with
// factors multiplied in, single channels and thresholds.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <string>

#include "core/formats/gltf/gltf_file.h"
#include "core/formats/conversion/conversion_report.h"
#include "core/formats/conversion/output_folder.h"
#include "core/formats/pictures/image_file.h"

namespace mote::core {

class GltfTextures {
  public:
    /// Pictures beside the glTF file are copied into `folder` where `copies` says so, else named where they
    /// are.
    GltfTextures(GltfFile& file, OutputFolder& folder, const std::string& prefix, bool copies,
                 ConversionReport& report)
        : file_(file), folder_(folder), prefix_(prefix), copies_(copies), report_(report) {}

    /// A picture for a textureInfo ("baseColorTexture": ...). `raw`: its 8-bit values are linear.
    struct Picture {
        std::string file;  ///< as the scene names it
        bool raw = false;
    };
    /// Nothing where there is no texture, or none that can be read.
    std::optional<std::size_t> image_of(const GltfValue& info);
    /// Set of texture coordinates that it is looked up with.
    static std::size_t uv_set(const GltfValue& info);

    Picture colours(std::size_t image, const Rgb& factor);
    /// Linear light: the decoded colours times `factor`; nothing where all of it is black.
    std::optional<Picture> light(std::size_t image, const Rgb& factor);
    /// Channel 0 to 2 of the stored values, times `factor`.
    Picture channel(std::size_t image, int channel, double factor);
    /// Alpha times `factor`; with `cutoff` 1 where that is reached, else 0. Nothing where all is opaque.
    std::optional<Picture> opacity(std::size_t image, double factor, std::optional<double> cutoff);
    /// x and y times `scale`; y turned over for `turned`.
    Picture normals(std::size_t image, double scale, bool turned);

    /// <texture type="bitmap">, wrapped, filtered and transformed as the textureInfo says.
    void add(pugi::xml_node parent, const std::string& name, const GltfValue& info, const Picture& picture);

  private:
    const std::string& original(std::size_t image);
    Bitmap read(std::size_t image, bool raw);
    Picture once(const std::string& key, const std::function<Picture()>& make);
    Picture write(const Bitmap& bitmap, bool grey);
    std::string new_name(const std::string& extension);

    GltfFile& file_;
    OutputFolder& folder_;
    std::string prefix_;
    bool copies_;
    ConversionReport& report_;
    std::map<std::size_t, std::string> originals_;  ///< paths
    std::map<std::string, Picture> made_;
    std::map<std::string, std::string> named_;  ///< path -> as the scene names it
    int count_ = 0;
};

}  // namespace mote::core
