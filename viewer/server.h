// The viewer's server: its page by HTTP, and messages by WebSocket, on one thread.
//
// It listens on the loopback address by default, and answers nothing whose path does not begin
// with a random token, whose Host is another one (a page elsewhere that has rebound its name), or whose
// Origin is another page. No file is read: the page is part of the program. Every client has bounds: bytes of
// a header and of a message, messages a second, bytes that wait for it, seconds of silence before its first
// request.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "viewer/message.h"

namespace mote::viewer {

/// Receives what clients do, in the server's thread.
class ServerEvents {
  public:
    virtual ~ServerEvents() = default;
    virtual void left(int client) = 0;
    virtual void received(int client, std::string_view text) = 0;
};

struct ServerSettings {
    std::string address = "127.0.0.1";
    unsigned short port = 0;  ///< 0: one that is free
    std::string token;        ///< "": a random one
};

class Server {
  public:
    static constexpr int max_clients = 10;
    static constexpr std::size_t max_message_bytes = 64 * 1024;
    static constexpr int max_messages_per_second = 200;
    static constexpr std::size_t max_waiting_bytes = std::size_t(256) << 20;  ///< then the client is dropped

    /// Listens. Throws core::InputError where the address cannot be used.
    explicit Server(const ServerSettings& settings);
    ~Server();  ///< ends the connections
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// "http://127.0.0.1:PORT/TOKEN/"
    const std::string& url() const;
    /// Serves in a thread of its own; `events` must live until stop() or the server's end.
    void start(ServerEvents& events);
    void stop();  ///< no more events; send() has no effect from now on
    /// From any thread; returns at once. A client that has gone is passed over.
    void send(int client, const SharedMessage& message);

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

/// 128 random bits of the system, in hexadecimal digits.
std::string random_token();

}  // namespace mote::viewer
