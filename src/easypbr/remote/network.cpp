// The only file that sees Boost.
#include "easypbr/remote/network.h"

#include <utility>  // Before Asio 1.74, which uses std::exchange without it.

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <thread>
#include <variant>

#include "easypbr/core/error.h"
#include "easypbr/remote/http_answer.h"

namespace easypbr::remote {
namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Code = boost::system::error_code;
using Stream = beast::basic_stream<net::generic::stream_protocol>;
using Tcp = net::ip::tcp;
using Local = net::local::stream_protocol;
using std::chrono::seconds;

/// What a connection tells the loop that owns it.
class Owner {
  public:
    virtual ~Owner() = default;
    virtual void opened(ClientId client) = 0;
    virtual void received(ClientId client, std::string_view text) = 0;
    virtual void closed(ClientId client) = 0;
    virtual const HostRules& hosts() const = 0;
};

std::string_view view_of(beast::string_view text) {
    return {text.data(), text.size()};
}

void add_safety(auto& message, const HostRules& hosts) {
    for (const auto& [name, value] : safety_headers(hosts)) message.set(name, value);
    message.set(http::field::server, "easypbr");
}

/// A connection, from its request to its end.
class Connection : public std::enable_shared_from_this<Connection> {
  public:
    Connection(Stream stream, ClientId id, Owner& owner)
        : socket_(std::move(stream)), id_(id), owner_(&owner), deadline_(socket_.get_executor()) {}

    void start() {
        parser_.header_limit(Network::most_header_bytes);
        parser_.body_limit(uint64_t(0));
        stream().expires_after(seconds(Network::header_s));
        http::async_read_header(stream(), buffer_, parser_,
                                [self = shared_from_this()](Code error, size_t) { self->on_request(error); });
    }

    bool is_stranger() const { return stranger_; }
    void admit() {
        stranger_ = false;
        deadline_.cancel();
        socket_.read_message_max(Network::most_bytes);
    }

    using Item = std::variant<SharedText, Packet>;
    void send(Item item) {
        if (closing_ || !open_) return;
        unread_ += size_of(item);
        queue_.push_back(std::move(item));
        if (unread_ > Network::most_unread_bytes) return close(CloseCode::refused, "reads too slowly");
        if (!writing_) write();
    }

    void close(CloseCode code, const std::string& reason) {
        if (std::exchange(closing_, true) || !open_) return;
        const websocket::close_reason why{websocket::close_code(uint16_t(code)), reason.substr(0, 120)};
        socket_.async_close(why, [self = shared_from_this()](Code) { self->end(); });
    }
    void close_later(CloseCode code, const std::string& reason, double delay_s) {
        deadline_.expires_after(std::chrono::milliseconds(int(delay_s * 1000)));
        deadline_.async_wait([self = shared_from_this(), code, reason](Code error) {
            if (!error) self->close(code, reason);
        });
    }
    /// Without a goodbye. The owner hears nothing any more.
    void drop() {
        owner_ = nullptr;
        stop_all();
    }

  private:
    Stream& stream() { return socket_.next_layer(); }

    static size_t size_of(const Item& item) {
        const auto* packet = std::get_if<Packet>(&item);
        return packet ? FrameHeader::size + packet->count : std::get<SharedText>(item)->size();
    }

    void on_request(Code error) {
        if (error || !owner_) return end();
        const auto& request = parser_.get();
        HttpRequest asked;
        const std::string method(request.method_string());
        asked.method = method;
        asked.target = view_of(request.target());
        asked.host = view_of(request[http::field::host]);
        asked.origin = view_of(request[http::field::origin]);
        asked.protocols = view_of(request[http::field::sec_websocket_protocol]);
        asked.hosts = int(request.count(http::field::host));
        asked.upgrade = websocket::is_upgrade(request);
        const HttpAnswer answer = remote::answer(asked, owner_->hosts());
        if (answer.is_socket) return accept();
        respond(answer, method == "HEAD");
    }

    void respond(const HttpAnswer& answer, bool head) {
        response_.emplace(http::status(answer.status), 11);
        add_safety(*response_, owner_->hosts());
        response_->set(http::field::content_type, beast::string_view(answer.type.data(), answer.type.size()));
        response_->keep_alive(false);
        response_->content_length(answer.body.size());
        if (!head) response_->body() = std::string(answer.body);
        serializer_.emplace(*response_);
        stream().expires_after(seconds(Network::header_s));
        http::async_write(stream(), *serializer_, [self = shared_from_this()](Code, size_t) {
            Code ignored;
            self->stream().socket().shutdown(net::socket_base::shutdown_send, ignored);
            self->end();
        });
    }

    void accept() {
        stream().expires_never();
        websocket::stream_base::timeout timeouts{};
        timeouts.handshake_timeout = seconds(Network::header_s);
        timeouts.idle_timeout = seconds(Network::idle_s);
        timeouts.keep_alive_pings = true;
        socket_.set_option(timeouts);
        socket_.set_option(websocket::stream_base::decorator([this](websocket::response_type& response) {
            response.set(http::field::sec_websocket_protocol,
                         beast::string_view(protocol_name.data(), protocol_name.size()));
            if (owner_) add_safety(response, owner_->hosts());
        }));
        socket_.read_message_max(Network::most_first_bytes);
        socket_.auto_fragment(false);
        socket_.async_accept(parser_.get(),
                             [self = shared_from_this()](Code error) { self->on_accepted(error); });
    }

    void on_accepted(Code error) {
        if (error || !owner_) return end();
        open_ = true;
        buffer_.clear();
        deadline_.expires_after(seconds(Network::token_s));
        deadline_.async_wait([self = shared_from_this()](Code cancelled) {
            if (!cancelled) self->close(CloseCode::refused, "no token came");
        });
        owner_->opened(id_);
        read();
    }

    void read() {
        socket_.async_read(buffer_,
                           [self = shared_from_this()](Code error, size_t) { self->on_message(error); });
    }

    void on_message(Code error) {
        if (error || !owner_) return end();
        if (!socket_.got_text())
            close(CloseCode::refused, "expected text");
        else if (!closing_)
            owner_->received(id_, {static_cast<const char*>(buffer_.data().data()), buffer_.size()});
        buffer_.clear();
        read();
    }

    void write() {
        writing_ = true;
        const Item& item = queue_.front();
        const auto done = [self = shared_from_this()](Code error, size_t) { self->on_written(error); };
        if (const auto* packet = std::get_if<Packet>(&item)) {
            socket_.binary(true);
            header_ = packet->header.encoded();
            const std::array<net::const_buffer, 2> parts = {
                net::const_buffer(header_.data(), header_.size()),
                net::const_buffer(packet->bytes->data() + packet->from, packet->count)};
            return socket_.async_write(parts, done);
        }
        socket_.text(true);
        socket_.async_write(net::buffer(*std::get<SharedText>(item)), done);
    }

    void on_written(Code error) {
        if (error) return end();
        unread_ -= size_of(queue_.front());
        queue_.pop_front();
        writing_ = false;
        if (!queue_.empty() && !closing_) write();
    }

    void stop_all() {
        deadline_.cancel();
        stream().close();
    }

    void end() {
        stop_all();
        if (Owner* owner = std::exchange(owner_, nullptr)) owner->closed(id_);
    }

    websocket::stream<Stream> socket_;
    ClientId id_;
    Owner* owner_;
    beast::flat_buffer buffer_;
    http::request_parser<http::empty_body> parser_;
    std::optional<http::response<http::string_body>> response_;
    std::optional<http::response_serializer<http::string_body>> serializer_;
    net::steady_timer deadline_;
    std::deque<Item> queue_;
    std::array<std::byte, FrameHeader::size> header_{};
    size_t unread_ = 0;
    bool open_ = false, writing_ = false, closing_ = false, stranger_ = true;
};

void remove_stale(const std::filesystem::path& path) {
    std::error_code ignored;
    if (!std::filesystem::is_socket(path, ignored)) return;
    net::io_context context;
    Local::socket probe(context);
    Code error;
    probe.connect(Local::endpoint(path.string()), error);
    if (!error) throw FileError(fmt::format("socket {}: another server listens there", path.string()));
    std::filesystem::remove(path, ignored);
}

}  // namespace

class Network::Loop : public Owner, public std::enable_shared_from_this<Network::Loop> {
  public:
    explicit Loop(const NetworkOptions& options)
        : options_(options), tcp_(context_), local_(context_), pause_(context_) {
        if (options.socket.empty())
            listen_tcp();
        else
            listen_local();
    }
    ~Loop() override { stop(); }

    void start(NetworkEvents& events) {
        events_ = &events;
        accept_next();
        thread_ = std::thread([this] { context_.run(); });
    }

    void stop() {
        if (!thread_.joinable()) return remove_socket();
        net::post(context_, [this] { say_goodbye(); });
        thread_.join();
        remove_socket();
    }

    int port() const { return options_.socket.empty() ? port_ : 0; }

    /// Has the loop's thread do something with a connection that is still there.
    void with(ClientId client, std::function<void(Connection&)> work) {
        net::post(context_, [this, client, work = std::move(work)] {
            const auto found = connections_.find(client);
            // Alive while it works: what it does may end it.
            if (found == connections_.end()) return;
            const std::shared_ptr<Connection> connection = found->second;
            work(*connection);
        });
    }

    void opened(ClientId client) override {
        if (events_) events_->opened(client);
    }
    void received(ClientId client, std::string_view text) override {
        if (events_) events_->received(client, text);
    }
    void closed(ClientId client) override {
        connections_.erase(client);
        if (events_) events_->closed(client);
        if (stopping_ && connections_.empty()) context_.stop();
    }
    const HostRules& hosts() const override { return options_.hosts; }

  private:
    void listen_tcp() {
        Code error;
        const auto address =
            net::ip::make_address(options_.bind == "localhost" ? "127.0.0.1" : options_.bind, error);
        if (error) throw ArgumentError(fmt::format("bind '{}': expected an address", options_.bind));
        const Tcp::endpoint place(address, static_cast<unsigned short>(options_.port));
        tcp_.open(place.protocol());
        tcp_.set_option(net::socket_base::reuse_address(true));
        tcp_.bind(place, error);
        if (!error) tcp_.listen(net::socket_base::max_listen_connections, error);
        if (error)
            throw Error(fmt::format("cannot listen on {} port {}: {}", options_.bind, options_.port,
                                    error.message()));
        port_ = tcp_.local_endpoint().port();
    }

    /// Nobody can connect before its mode is set: it listens last.
    void listen_local() {
        remove_stale(options_.socket);
        Code error;
        const std::string path = options_.socket.string();
        if (path.size() >= 108)
            throw FileError(fmt::format("socket {}: its path is longer than 107 bytes", path));
        local_.open(Local());
        local_.bind(Local::endpoint(path), error);
        if (!error && chmod(path.c_str(), 0600) != 0) error.assign(errno, boost::system::system_category());
        if (!error) local_.listen(net::socket_base::max_listen_connections, error);
        if (error) throw FileError(fmt::format("cannot make the socket {}: {}", path, error.message()));
        bound_ = true;
    }

    void accept_next() {
        if (stopping_) return;
        if (options_.socket.empty())
            tcp_.async_accept([this](Code error, Tcp::socket socket) {
                if (!error) {
                    Code ignored;
                    socket.set_option(Tcp::no_delay(true), ignored);
                    const int low_water = 64 * 1024;
                    setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &low_water,
                               sizeof low_water);
                    begin(net::generic::stream_protocol::socket(std::move(socket)));
                }
                after_accept(error);
            });
        else
            local_.async_accept([this](Code error, Local::socket socket) {
                if (!error) begin(net::generic::stream_protocol::socket(std::move(socket)));
                after_accept(error);
            });
    }

    /// Out of descriptors, say: a loop without a pause would burn a core.
    void after_accept(Code error) {
        if (error == net::error::operation_aborted) return;
        if (!error) return accept_next();
        pause_.expires_after(std::chrono::milliseconds(100));
        pause_.async_wait([this](Code stopped) {
            if (!stopped) accept_next();
        });
    }

    void begin(net::generic::stream_protocol::socket socket) {
        size_t strangers = 0;
        for (const auto& [id, connection] : connections_) strangers += size_t(connection->is_stranger());
        if (strangers >= most_strangers) return;  // Closed as it goes out of scope.
        const ClientId id = next_++;
        const auto connection = std::make_shared<Connection>(Stream(std::move(socket)), id, *this);
        connections_[id] = connection;
        connection->start();
    }

    void say_goodbye() {
        stopping_ = true;
        events_ = nullptr;
        Code ignored;
        tcp_.close(ignored);
        local_.close(ignored);
        pause_.expires_after(std::chrono::milliseconds(500));
        pause_.async_wait([this](Code) { drop_all(); });
        const auto connections = connections_;
        for (const auto& [id, connection] : connections) {
            if (connection->is_stranger()) connection->drop();
            if (connection->is_stranger()) connections_.erase(id);
            connection->close(CloseCode::going_away, "the server ends");
        }
        if (connections_.empty()) context_.stop();
    }

    void drop_all() {
        for (const auto& [id, connection] : connections_) connection->drop();
        connections_.clear();
        context_.stop();
    }

    void remove_socket() {
        std::error_code ignored;
        if (std::exchange(bound_, false)) std::filesystem::remove(options_.socket, ignored);
    }

    NetworkOptions options_;
    NetworkEvents* events_ = nullptr;
    net::io_context context_{1};
    Tcp::acceptor tcp_;
    Local::acceptor local_;
    net::steady_timer pause_;
    std::map<ClientId, std::shared_ptr<Connection>> connections_;
    ClientId next_ = 1;
    int port_ = 0;
    bool stopping_ = false, bound_ = false;
    std::thread thread_;
};

Network::Network(const NetworkOptions& options) : loop_(std::make_shared<Loop>(options)) {}

Network::~Network() {
    loop_->stop();
}

void Network::start(NetworkEvents& events) {
    loop_->start(events);
}

void Network::stop() {
    loop_->stop();
}

int Network::port() const {
    return loop_->port();
}

void Network::admit(ClientId client) {
    loop_->with(client, [](Connection& connection) { connection.admit(); });
}

void Network::send(ClientId client, SharedText text) {
    loop_->with(client, [text = std::move(text)](Connection& connection) { connection.send(text); });
}

void Network::send(ClientId client, Packet packet) {
    loop_->with(client, [packet = std::move(packet)](Connection& connection) { connection.send(packet); });
}

void Network::close(ClientId client, CloseCode code, const std::string& reason, double delay_s) {
    loop_->with(client, [code, reason, delay_s](Connection& connection) {
        if (delay_s > 0)
            connection.close_later(code, reason, delay_s);
        else
            connection.close(code, reason);
    });
}

}  // namespace easypbr::remote
