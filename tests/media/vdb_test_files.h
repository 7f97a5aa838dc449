// Test grids written by mote_test_grid_writer, in a folder that is removed at the end.
#pragma once

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "core/math/transform.h"
#include "core/objects/error.h"
#include "media/vdb_grid.h"
#include "tests/support/temporary_folder.h"

namespace mote::tests {

class GridFolder : public TemporaryFolder {
  public:
    /// A file of the given kind (see tools/main_write_test_grids.cpp) under the given transform.
    std::string grid(const std::string& kind, const core::Transform* index_to_world = nullptr) const {
        const std::string path = file(kind + ".vdb");
        std::string command = std::string(MOTE_BINARY_DIR) + "/mote_test_grid_writer '" + path + "' " + kind;
        char number[40];
        for (int i = 0; index_to_world && i < 16; ++i) {
            std::snprintf(number, sizeof number, " %.17g", index_to_world->matrix[i / 4][i % 4]);
            command += number;
        }
        if (std::system(command.c_str()) != 0) throw std::runtime_error("cannot write " + path);
        return path;
    }
};

inline std::string read_bytes(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
inline void write_bytes(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

/// The message with which a grid is refused, or "" when it is read.
inline std::string vdb_refusal(const std::string& path, const std::string& grid = "density",
                               const media::VdbLoadOptions& options = {}) {
    try {
        media::load_vdb_grid(path, grid, options);
    } catch (const core::InputError& e) {
        return e.what();
    }
    return "";
}

}  // namespace mote::tests
