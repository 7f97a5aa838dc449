#include "viewer/server.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>
#include <map>
#include <optional>
#include <stdexcept>
#include <thread>

#include "core/objects/error.h"
#include "viewer/page_files.h"

namespace mote::viewer {

namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
namespace net = boost::asio;
using tcp = net::ip::tcp;
using Error = beast::error_code;
using Clock = std::chrono::steady_clock;
using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;

constexpr int max_connections = 40;  ///< of any kind
constexpr std::size_t max_header_bytes = 8192, max_body_bytes = 4096;
constexpr auto http_seconds = std::chrono::seconds(10), silent_seconds = std::chrono::seconds(60);

bool equal_in_constant_time(std::string_view a, std::string_view b) {
    unsigned difference = a.size() == b.size() ? 0 : 1;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        difference |= unsigned(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
    return difference == 0;
}

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

}  // namespace

std::string random_token() {
    unsigned char bytes[16];
    if (::getrandom(bytes, sizeof bytes, 0) != sizeof bytes)
        throw std::runtime_error("the system gives no random numbers");
    std::string token;
    for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
    return token;
}

class Server::Impl {
  public:
    explicit Impl(const ServerSettings& settings)
        : token_(settings.token.empty() ? random_token() : settings.token), acceptor_(context_) {
        try {
            const tcp::endpoint endpoint(net::ip::make_address(settings.address), settings.port);
            acceptor_.open(endpoint.protocol());
            acceptor_.set_option(net::socket_base::reuse_address(true));
            acceptor_.bind(endpoint);
            acceptor_.listen();
        } catch (const boost::system::system_error& error) {
            throw core::InputError(fmt::format("cannot listen on {}:{}: {}", settings.address, settings.port,
                                               error.code().message()));
        }
        const std::string shown =
            endpoint().address().is_v6() ? "[" + settings.address + "]" : settings.address;
        host_ = fmt::format("{}:{}", shown, endpoint().port());
        url_ = fmt::format("http://{}/{}/", host_, token_);
    }
    ~Impl() {
        stop();
        for (const auto& [client, socket] : sockets_)
            if (const auto alive = socket.lock()) alive->end();
    }
    void stop() {
        context_.stop();
        if (thread_.joinable()) thread_.join();
    }

    const std::string& url() const { return url_; }
    void start(ServerEvents& events) {
        events_ = &events;
        accept();
        thread_ = std::thread([this] { context_.run(); });
    }
    void send(int client, const SharedMessage& message) {
        net::post(context_, [this, client, message] {
            if (const auto found = sockets_.find(client); found != sockets_.end())
                if (const auto socket = found->second.lock()) socket->send(message);
        });
    }

  private:
    /// Counts a connection while it lives.
    class Counted {
      public:
        explicit Counted(int& count) : count_(count) { ++count_; }
        ~Counted() { --count_; }
        Counted(const Counted&) = delete;
        Counted& operator=(const Counted&) = delete;

      private:
        int& count_;
    };

    /// A client that exchanges messages.
    class Socket : public std::enable_shared_from_this<Socket> {
      public:
        Socket(Impl& server, beast::tcp_stream&& stream, std::shared_ptr<Counted> counted)
            : server_(server),
              counted_(std::move(counted)),
              stream_(std::move(stream)),
              timer_(server.context_),
              client_(server.next_client_++) {}
        ~Socket() {
            if (!joined_) return;
            server_.sockets_.erase(client_);
            server_.events_->left(client_);
        }
        void end() { joined_ = false; }  ///< without an event

        void start(const Request& request) {
            beast::get_lowest_layer(stream_).expires_never();
            stream_.set_option({http_seconds, silent_seconds, true});  // pings what is silent
            stream_.read_message_max(max_message_bytes);
            stream_.async_accept(request, [self = this->shared_from_this()](Error error) {
                if (!error) self->join();
            });
        }
        void send(const SharedMessage& message) {
            waiting_bytes_ += message->bytes.size();
            if (waiting_bytes_ > max_waiting_bytes) return drop();
            waiting_.push_back(message);
            if (waiting_.size() == 1) write();
        }

      private:
        void join() {
            joined_ = true;
            server_.sockets_[client_] = this->weak_from_this();
            read();
        }
        void drop() { beast::get_lowest_layer(stream_).close(); }
        void read() {
            stream_.async_read(buffer_, [self = this->shared_from_this()](Error error, std::size_t) {
                if (!error) self->take();
            });
        }
        void take() {
            const auto data = buffer_.cdata();
            if (stream_.got_text())
                server_.events_->received(client_, {static_cast<const char*>(data.data()), data.size()});
            buffer_.consume(buffer_.size());
            const auto now = Clock::now();
            if (now - second_ > std::chrono::seconds(1)) second_ = now, messages_ = 0;
            if (++messages_ < max_messages_per_second) return read();
            timer_.expires_at(second_ + std::chrono::seconds(1));
            timer_.async_wait([self = this->shared_from_this()](Error error) {
                if (!error) self->read();
            });
        }
        void write() {
            stream_.binary(waiting_.front()->binary);
            stream_.async_write(net::buffer(waiting_.front()->bytes),
                                [self = this->shared_from_this()](Error error, std::size_t) {
                                    if (error) return self->drop();
                                    self->waiting_bytes_ -= self->waiting_.front()->bytes.size();
                                    self->waiting_.pop_front();
                                    if (!self->waiting_.empty()) self->write();
                                });
        }

        Impl& server_;
        std::shared_ptr<Counted> counted_;
        websocket::stream<beast::tcp_stream> stream_;
        net::steady_timer timer_;
        beast::flat_buffer buffer_;
        std::deque<SharedMessage> waiting_;
        std::size_t waiting_bytes_ = 0;
        Clock::time_point second_ = Clock::now();
        int messages_ = 0;  ///< since `second_`
        int client_;
        bool joined_ = false;
    };

    /// A connection until it becomes a Socket, or ends.
    class Connection : public std::enable_shared_from_this<Connection> {
      public:
        Connection(Impl& server, tcp::socket&& socket)
            : server_(server),
              counted_(std::make_shared<Counted>(server.connections_)),
              stream_(std::move(socket)),
              buffer_(max_header_bytes + max_body_bytes) {}

        void read() {
            parser_.emplace();
            parser_->header_limit(max_header_bytes), parser_->body_limit(max_body_bytes);
            stream_.expires_after(http_seconds);
            http::async_read(stream_, buffer_, *parser_,
                             [self = this->shared_from_this()](Error error, std::size_t) {
                                 if (error == http::error::end_of_stream) return self->close();
                                 if (error) return self->refuse_malformed(error);
                                 self->answer(self->parser_->release());
                             });
        }

      private:
        void refuse_malformed(Error error) {
            if (error.category() != http::make_error_code(http::error::bad_method).category()) return;
            respond({http::status::bad_request, 11}, "The request is malformed.\n", "text/plain");
        }
        void answer(const Request& request) {
            const Answer answer = server_.answer(request);
            if (answer.becomes_socket)
                return std::make_shared<Socket>(server_, std::move(stream_), counted_)->start(request);
            Response response{answer.status, request.version()};
            response.keep_alive(request.keep_alive() && answer.status == http::status::ok);
            respond(std::move(response), answer.body, answer.type);
        }
        void respond(Response response, std::string_view body, std::string_view type) {
            response.set(http::field::content_type, beast::string_view(type.data(), type.size()));
            response.set(http::field::cache_control, "no-store");
            response.set("X-Content-Type-Options", "nosniff");
            response.set("Referrer-Policy", "no-referrer");
            response.set("Content-Security-Policy",
                         "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; "
                         "connect-src 'self'; img-src 'self' data: blob:; frame-ancestors 'none'");
            response.body() = std::string(body);
            response.prepare_payload();
            response_ = std::make_shared<Response>(std::move(response));
            http::async_write(stream_, *response_,
                              [self = this->shared_from_this()](Error error, std::size_t) {
                                  if (error || !self->response_->keep_alive()) return self->close();
                                  self->read();
                              });
        }
        void close() {
            Error ignored;
            stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
        }

        Impl& server_;
        std::shared_ptr<Counted> counted_;
        beast::tcp_stream stream_;
        beast::flat_buffer buffer_;
        std::optional<http::request_parser<http::string_body>> parser_;
        std::shared_ptr<Response> response_;
    };

    struct Answer {
        http::status status = http::status::ok;
        std::string_view body, type = "text/plain";
        bool becomes_socket = false;
    };

    tcp::endpoint endpoint() const { return acceptor_.local_endpoint(); }

    /// The name by which a browser on this machine may reach it, too.
    bool is_own_host(std::string_view host) const {
        return host == host_ || host == fmt::format("localhost:{}", endpoint().port());
    }
    bool is_own_origin(std::string_view origin) const {
        constexpr std::string_view scheme = "http://";
        return origin.starts_with(scheme) && is_own_host(origin.substr(scheme.size()));
    }
    Answer answer(const Request& request) const {
        if (!is_own_host(view_of(request[http::field::host])))
            return {http::status::forbidden, "This Host is not served.\n"};
        const auto origin = request.find(http::field::origin);
        if (origin != request.end() && !is_own_origin(view_of(origin->value())))
            return {http::status::forbidden, "Pages of another origin are not served.\n"};
        std::string_view target = view_of(request.target());
        target = target.substr(0, target.find('?'));
        if (target.size() < token_.size() + 2 || target[0] != '/' ||
            !equal_in_constant_time(target.substr(1, token_.size()), token_) ||
            target[token_.size() + 1] != '/')
            return {http::status::not_found,
                    "There is nothing here: the address needs the token that mote "
                    "view has printed.\n"};
        const std::string_view path = target.substr(token_.size() + 2);
        if (request.method() != http::verb::get)
            return {http::status::method_not_allowed, "Only GET is served.\n"};
        if (path == "socket") {
            if (!websocket::is_upgrade(request)) return {http::status::bad_request, "Not a WebSocket.\n"};
            if (int(sockets_.size()) >= max_clients)
                return {http::status::service_unavailable, "Too many clients.\n"};
            return {http::status::ok, "", "", true};
        }
        const PageFile* const file = find_page_file(path.empty() ? "index.html" : path);
        if (!file) return {http::status::not_found, "The page has no such file.\n"};
        return {http::status::ok, file->text, file->type};
    }

    void accept() {
        acceptor_.async_accept([this](Error error, tcp::socket socket) {
            if (error == net::error::operation_aborted) return;
            if (!error && connections_ < max_connections)
                std::make_shared<Connection>(*this, std::move(socket))->read();
            accept();
        });
    }

    std::string token_, host_, url_;
    ServerEvents* events_ = nullptr;
    int connections_ = 0, next_client_ = 1;
    std::map<int, std::weak_ptr<Socket>> sockets_;
    net::io_context context_{1};  // destroyed, with all connections, before what they use
    tcp::acceptor acceptor_;
    std::thread thread_;
};

Server::Server(const ServerSettings& settings) : impl_(std::make_unique<Impl>(settings)) {}
Server::~Server() = default;
const std::string& Server::url() const { return impl_->url(); }
void Server::start(ServerEvents& events) { impl_->start(events); }
void Server::stop() { impl_->stop(); }
void Server::send(int client, const SharedMessage& message) { impl_->send(client, message); }

}  // namespace mote::viewer
