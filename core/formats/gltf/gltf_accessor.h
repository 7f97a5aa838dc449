// Numbers in a buffer: accessors, of all component types, normalized, interleaved or sparse.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "core/formats/gltf/gltf_file.h"

namespace mote::core {

class GltfAccessor {
  public:
    /// Throws InputError where the numbers do not lie within their buffer, or there are more than 2^28.
    GltfAccessor(GltfFile& file, std::size_t index);

    std::size_t size() const { return count_; }
    int components() const { return components_; }
    /// Value of element i < size(), component c < components(). Integers that are `normalized` lie in [0, 1]
    /// or
    /// [-1, 1].
    float value(std::size_t i, int c) const;
    /// Element i of an accessor of whole numbers.
    std::uint32_t whole(std::size_t i) const;
    const GltfValue& place() const { return value_; }

  private:
    /// `size` elements of `stride` bytes.
    struct Numbers {
        std::span<const std::byte> bytes;
        std::size_t stride;
        int type;  ///< componentType
    };
    Numbers numbers(GltfFile& file, const GltfValue& value, std::size_t count, int type, int components,
                    bool strided) const;
    void read_sparse(GltfFile& file, const GltfValue& sparse);

    GltfValue value_;
    std::size_t count_;
    int type_, components_;
    bool normalized_;
    Numbers dense_{{}, 0, 0};
    Numbers sparse_{{}, 0, 0};
    std::map<std::uint32_t, std::uint32_t> replaced_;  ///< element -> element of sparse_
};

}  // namespace mote::core
