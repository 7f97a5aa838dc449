#include "apps/tev_viewer.h"

#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>

#include "core/objects/error.h"

namespace mote::apps {

namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::uint8_t update_image = 3, create_image = 4;
constexpr const char* channels[] = {"R", "G", "B"};
constexpr int step_milliseconds = 100;       // between checks for the end while waiting
constexpr int patience_milliseconds = 3000;  // with a viewer that takes nothing

class Message {
  public:
    explicit Message(std::uint8_t operation) : bytes_(sizeof(std::uint32_t)) { add(operation); }
    template <typename T>
    void add(T value) {
        const std::size_t at = bytes_.size();
        bytes_.resize(at + sizeof(T));
        std::memcpy(bytes_.data() + at, &value, sizeof(T));
    }
    void add(const std::string& text) {
        bytes_.insert(bytes_.end(), text.c_str(), text.c_str() + text.size() + 1);
    }
    const std::vector<char>& finished() {
        const auto length = std::uint32_t(bytes_.size());
        std::memcpy(bytes_.data(), &length, sizeof(length));
        return bytes_;
    }

  private:
    std::vector<char> bytes_;
};

}  // namespace

struct TevViewer::Shared {
    std::string host, port, name;
    int width, height;

    std::mutex mutex;
    std::condition_variable changed;
    std::optional<std::vector<core::Rgb>> next;  ///< picture to be sent
    bool ends = false, idle = true, abandoned = false;
    int socket = -1;  ///< of the thread alone

    void run() {
        std::unique_lock lock(mutex);
        for (;;) {
            idle = true;
            changed.notify_all();
            changed.wait(lock, [&] { return next || ends; });
            if (!next) break;
            const std::vector<core::Rgb> picture = std::move(*next);
            next.reset();
            idle = false;
            lock.unlock();
            if (!send_picture(picture)) close_socket();
            lock.lock();
        }
        close_socket();
    }

  private:
    bool is_abandoned() {
        const std::lock_guard lock(mutex);
        return abandoned;
    }
    void close_socket() {
        if (socket >= 0) ::close(socket);
        socket = -1;
    }
    /// False where nothing happened for too long, or it is not wanted any more.
    bool wait_for(short events) {
        for (int waited = 0; waited < patience_milliseconds && !is_abandoned(); waited += step_milliseconds) {
            pollfd one{socket, events, 0};
            const int ready = ::poll(&one, 1, step_milliseconds);
            if (ready > 0) return (one.revents & (POLLERR | POLLNVAL)) == 0;
            if (ready < 0 && errno != EINTR) return false;
        }
        return false;
    }
    bool connect_to(const addrinfo& address) {
        socket = ::socket(address.ai_family, address.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC,
                          address.ai_protocol);
        if (socket < 0) return false;
        int error = ::connect(socket, address.ai_addr, address.ai_addrlen) == 0 ? 0 : errno;
        if (error == EINPROGRESS && wait_for(POLLOUT)) {
            socklen_t size = sizeof(error);
            if (::getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size) != 0) error = errno;
        }
        if (error != 0) close_socket();
        return error == 0;
    }
    bool open_viewer() {
        addrinfo hints{}, *found = nullptr;
        hints.ai_socktype = SOCK_STREAM;
        if (::getaddrinfo(host.c_str(), port.c_str(), &hints, &found) != 0) return false;
        bool connected = false;
        for (const addrinfo* a = found; a && !connected; a = a->ai_next) connected = connect_to(*a);
        ::freeaddrinfo(found);
        if (!connected) return false;
        Message message(create_image);
        message.add(std::uint8_t(1)), message.add(name);
        message.add(std::int32_t(width)), message.add(std::int32_t(height)), message.add(std::int32_t(3));
        for (const char* channel : channels) message.add(std::string(channel));
        return send_all(message.finished());
    }
    bool send_all(const std::vector<char>& bytes) {
        for (std::size_t sent = 0; sent < bytes.size();) {
            const ssize_t more = ::send(socket, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
            if (more > 0)
                sent += std::size_t(more);
            else if (errno == EAGAIN || errno == EWOULDBLOCK ? !wait_for(POLLOUT) : errno != EINTR)
                return false;
        }
        return true;
    }
    bool send_tile(const std::vector<core::Rgb>& picture, int x, int y, int channel) {
        const int w = std::min(tile, width - x), h = std::min(tile, height - y);
        Message message(update_image);
        message.add(std::uint8_t(0)), message.add(name), message.add(std::string(channels[channel]));
        for (const int number : {x, y, w, h}) message.add(std::int32_t(number));
        for (int row = y; row < y + h; ++row)
            for (int column = x; column < x + w; ++column)
                message.add(picture[std::size_t(row) * std::size_t(width) + std::size_t(column)][channel]);
        return send_all(message.finished());
    }
    bool send_picture(const std::vector<core::Rgb>& picture) {
        if (socket < 0 && !open_viewer()) return false;  // the viewer may be started later
        for (int y = 0; y < height; y += tile)
            for (int x = 0; x < width; x += tile)
                for (int channel = 0; channel < 3; ++channel)
                    if (!send_tile(picture, x, y, channel)) return false;
        return true;
    }
};

TevViewer::TevViewer(const std::string& address, std::string name, int width, int height)
    : shared_(std::make_shared<Shared>()) {
    const std::string usual = default_address;
    const std::size_t colon = address.rfind(':');
    shared_->host = address.substr(0, colon);
    shared_->port = colon == std::string::npos ? "" : address.substr(colon + 1);
    if (shared_->host.empty()) shared_->host = usual.substr(0, usual.find(':'));
    if (shared_->port.empty()) shared_->port = usual.substr(usual.find(':') + 1);
    const bool digits = shared_->port.find_first_not_of("0123456789") == std::string::npos;
    if (!digits || shared_->port.size() > 5 || std::stoi(shared_->port) > 65535)
        throw core::InputError("--tev " + core::printable(address) + ": expected HOST:PORT");
    shared_->name = std::move(name), shared_->width = width, shared_->height = height;
    try {
        // Looking up a host's name cannot be interrupted, so the thread is not joined: it shares what it
        // needs.
        std::thread([shared = shared_] { shared->run(); }).detach();
    } catch (const std::system_error&) {  // no thread left: no live pictures
        shared_->ends = true;
    }
}

TevViewer::~TevViewer() {
    std::unique_lock lock(shared_->mutex);
    shared_->changed.wait_for(lock, std::chrono::duration<double>(max_seconds_at_end),
                              [&] { return shared_->ends || (shared_->idle && !shared_->next); });
    shared_->ends = shared_->abandoned = true;
    shared_->next.reset();
    shared_->changed.notify_all();
}

void TevViewer::show(std::vector<core::Rgb> picture) {
    const std::lock_guard lock(shared_->mutex);
    if (shared_->ends) return;
    shared_->next = std::move(picture);
    shared_->changed.notify_all();
}

}  // namespace mote::apps
