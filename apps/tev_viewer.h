// Live pictures in tev, a viewer of high dynamic range pictures that listens on a TCP port.
//
// Little-endian: [u32 length, itself included][u8 operation][payload]; texts end with a zero byte.
//   CreateImage (4): u8 take the focus, name, i32 width, height, channels, a name for each channel
//   UpdateImage (3): u8 take the focus, name, name of the channel, i32 x, y, width, height, floats row by row
//
// A thread of its own does the sending. No caller ever waits for it: of pictures that come while one is on
// its way only the last is kept, and where no viewer listens nothing happens.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/math/vec.h"

namespace mote::apps {

class TevViewer {
  public:
    static constexpr const char* default_address = "127.0.0.1:14158";
    static constexpr int tile = 128;  ///< edge of what one UpdateImage holds [pixels]
    /// Time for the last picture when all is done [s]; a viewer that takes longer does not get it.
    static constexpr double max_seconds_at_end = 1.0;

    /// `address`: HOST:PORT, HOST or :PORT. Throws InputError where it is none of these. `name`: of the
    /// picture.
    TevViewer(const std::string& address, std::string name, int width, int height);
    ~TevViewer();  ///< waits for the last picture at most max_seconds_at_end
    TevViewer(const TevViewer&) = delete;
    TevViewer& operator=(const TevViewer&) = delete;

    /// Pixels row by row from the top. Returns at once.
    void show(std::vector<core::Rgb> picture);

  private:
    struct Shared;
    std::shared_ptr<Shared> shared_;
};

}  // namespace mote::apps
