// Live pictures: what a viewer receives, and that no render waits for one.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <cstring>

#include "apps/tev_viewer.h"
#include "core/formats/pictures/image_file.h"
#include "core/objects/error.h"
#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"

using namespace mote::core;
using namespace mote::tests;
using mote::apps::TevViewer;

namespace {

/// A viewer: listens, and keeps what it is sent.
class Listener {
  public:
    Listener() {
        socket_ = ::socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in address{};
        address.sin_family = AF_INET, address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof(address);
        REQUIRE(::bind(socket_, reinterpret_cast<sockaddr*>(&address), size) == 0);
        REQUIRE(::listen(socket_, 4) == 0);
        REQUIRE(::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) == 0);
        address_ = "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    }
    ~Listener() { ::close(socket_); }
    const std::string& address() const { return address_; }
    /// All bytes of one client, to its end.
    std::string receive() const {
        pollfd one{socket_, POLLIN, 0};
        if (::poll(&one, 1, 20000) <= 0) return "";
        const int client = ::accept(socket_, nullptr, nullptr);
        std::string all;
        std::vector<char> some(1 << 16);
        for (ssize_t n; (n = ::recv(client, some.data(), some.size(), 0)) > 0;)
            all.append(some.data(), std::size_t(n));
        ::close(client);
        return all;
    }

  private:
    int socket_ = -1;
    std::string address_;
};

/// Image that tev would show: the last value of every pixel.
struct Shown {
    std::string name;
    int width = 0, height = 0, creations = 0, updates = 0, largest = 0;
    std::map<std::string, std::vector<float>> channels;

    explicit Shown(std::string bytes) {
        std::size_t at = 0;
        const auto number = [&]<typename T>(T value) {
            REQUIRE(at + sizeof(T) <= bytes.size());
            std::memcpy(&value, bytes.data() + at, sizeof(T));
            at += sizeof(T);
            return value;
        };
        const auto text = [&] {
            const std::string t = bytes.c_str() + at;
            at += t.size() + 1;
            return t;
        };
        while (at < bytes.size()) {
            const std::size_t begin = at, length = number(std::uint32_t());
            const int operation = number(std::uint8_t());
            number(std::uint8_t());
            if (operation == 4) {
                ++creations;
                name = text(), width = number(std::int32_t()), height = number(std::int32_t());
                for (std::int32_t n = number(std::int32_t()); n > 0; --n)
                    channels[text()].resize(std::size_t(width) * std::size_t(height));
            } else {
                REQUIRE(operation == 3);
                ++updates;
                CHECK(text() == name);
                std::vector<float>& channel = channels.at(text());
                const int x = number(std::int32_t()), y = number(std::int32_t());
                const int w = number(std::int32_t()), h = number(std::int32_t());
                largest = std::max({largest, w, h});
                REQUIRE((x >= 0 && y >= 0 && x + w <= width && y + h <= height));
                for (int row = y; row < y + h; ++row)
                    for (int column = x; column < x + w; ++column)
                        channel[std::size_t(row * width + column)] = number(float());
            }
            REQUIRE(at == begin + length);
        }
    }
};

const char* const scene = R"(<scene version="3.0.0"><sensor type="perspective"><film type="hdrfilm">
    <integer name="width" value="150"/><integer name="height" value="40"/></film><transform name="to_world">
    <lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>
    <shape type="sphere"/><emitter type="constant"/></scene>)";

double seconds_of(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

TEST_CASE("a viewer is shown the picture, in tiles, to the bits of the file", "[tev]") {
    const TemporaryFolder folder;
    write_file(folder.file("scene.xml"), scene);
    const Listener listener;
    MoteProcess process(folder, {"render", "scene.xml", "--integrator", "path", "--passes", "20", "-o",
                                 "a.exr", "--tev=" + listener.address()});
    const Shown shown(listener.receive());
    REQUIRE(process.wait().exit_code == 0);
    CHECK(shown.name == "a.exr");
    CHECK(shown.creations == 1);
    CHECK(shown.updates >= 6);  // two tiles of three channels
    CHECK(shown.largest == 128);
    const ImageChannels file = read_exr(folder.file("a.exr"));
    for (const char* name : {"R", "G", "B"}) CHECK((shown.channels.at(name) == *file.find(name)));
}

TEST_CASE("where no viewer listens nothing is said", "[tev]") {
    const TemporaryFolder folder;
    write_file(folder.file("scene.xml"), scene);
    std::string unused;
    { unused = Listener().address(); }
    const auto render = [&](const std::string& address, const std::string& name) {
        return run_mote(folder, {"render", "scene.xml", "--integrator", "path", "--passes", "2", "-o", name,
                                 "--quiet", "--tev=" + address});
    };
    const RunResult result = render(unused, "a.exr");
    CHECK(result.exit_code == 0);
    CHECK(result.err.empty());
    CHECK(render("127.0.0.1:x", "b.exr").exit_code == 1);
    CHECK(render("127.0.0.1:123456", "b.exr").exit_code == 1);
}

TEST_CASE("a viewer that takes nothing delays unused, and the next picture replaces the one that waits",
          "[tev]") {
    const Listener listener;    // accepts and never reads
    constexpr int size = 2000;  // 48 MB: more than any socket buffer
    const std::vector<Rgb> picture(std::size_t(size) * size, Rgb(1.0f));
    double showing = 0.0;
    const double all = seconds_of([&] {
        TevViewer viewer(listener.address(), "large", size, size);
        for (int i = 0; i < 5; ++i) {
            auto copy = picture;
            showing = std::max(showing, seconds_of([&] { viewer.show(std::move(copy)); }));
        }
    });
    // The second at the end, and time for a busy machine.
    CHECK(showing < 0.5);
    CHECK(all < TevViewer::max_seconds_at_end + 5.0);
}

TEST_CASE("the last picture is sent before the end", "[tev]") {
    const Listener listener;
    std::string bytes;
    std::thread reader([&] { bytes = listener.receive(); });
    {
        TevViewer viewer(listener.address(), "two", 2, 1);
        viewer.show({Rgb(1.0f), Rgb(2.0f, 3.0f, 4.0f)});
    }
    reader.join();
    const Shown shown(bytes);
    CHECK((shown.channels.at("G") == std::vector<float>{1.0f, 3.0f}));
    CHECK_THROWS_AS(TevViewer("host:port", "", 1, 1), InputError);
}
