#include "easypbr/remote/network.h"

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <pthread.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/post.hpp>
#include <chrono>
#include <functional>
#include <map>
#include <set>
#include <thread>

#include "easypbr/core/error.h"
#include "easypbr/core/start_thread.h"
#include "easypbr/remote/connection.h"
#include "easypbr/remote/inbox.h"

namespace easypbr::remote {
namespace {

using Tcp = net::ip::tcp;
using Local = net::local::stream_protocol;

constexpr double lag_memory = 0.8;

net::ip::address address_of(const std::string& bind) {
    Code error;
    const auto address = net::ip::make_address(bind == "localhost" ? "127.0.0.1" : bind, error);
    if (error) throw ArgumentError(fmt::format("bind '{}': expected an address", bind));
    return address;
}

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

/// Nobody can connect any more, even where a forked child holds a copy of the socket.
template <class Acceptor>
void close_listening(Acceptor& acceptor) {
    if (!acceptor.is_open()) return;
    ::shutdown(acceptor.native_handle(), SHUT_RDWR);
    Code ended;
    acceptor.non_blocking(true, ended);
    // Those whom a Unix socket has not accepted yet wait until its last copy is closed; TCP has reset them.
    while (!ended) {
        typename Acceptor::protocol_type::socket waiting(acceptor.get_executor());
        acceptor.accept(waiting, ended);
        Code ignored;
        if (!ended) waiting.shutdown(net::socket_base::shutdown_both, ignored);
    }
    acceptor.close(ended);
}

}  // namespace

void check_address(const std::string& bind) {
    address_of(bind);
}

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

    void start(WireEvents& events) {
        events_ = &events;
        accept_next();
        thread_ = started([this] { return std::thread([this] { context_.run(); }); });
        // Its share of the machine is told apart from the drawing's.
        ::pthread_setname_np(thread_.native_handle(), "easypbr network");
    }

    void stop() {
        if (!thread_.joinable()) return remove_socket();
        net::post(context_, [this] { say_goodbye(); });
        thread_.join();
        remove_socket();
    }

    double lag_s() const { return lag_s_; }

    int port() const { return options_.socket.empty() ? port_ : 0; }

    /// Has the loop's thread do something with a connection that is still there.
    void with(ClientId client, std::function<void(Connection&)> work) {
        net::post(context_, [this, client, work = std::move(work), given_s = now_seconds()] {
            // The longest of late, which a few quick ones do not hide.
            lag_s_ = std::max(now_seconds() - given_s, lag_memory * lag_s_);
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
        const Tcp::endpoint place(address_of(options_.bind), static_cast<unsigned short>(options_.port));
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
        drop_oldest_stranger();
        const ClientId id = next_++;
        const auto connection = std::make_shared<Connection>(Stream(std::move(socket)), id, *this);
        connections_[id] = connection;
        connection->start();
    }

    /// Where there are as many as may be: who is silent keeps nobody out.
    void drop_oldest_stranger() {
        const auto is_stranger = [](const auto& each) { return each.second->is_stranger(); };
        if (std::ranges::count_if(connections_, is_stranger) < std::ptrdiff_t(most_strangers)) return;
        const auto oldest = std::ranges::find_if(connections_, is_stranger);
        const ClientId id = oldest->first;
        oldest->second->drop();
        closed(id);
    }

    void say_goodbye() {
        stopping_ = true;
        events_ = nullptr;
        close_listening(tcp_);
        close_listening(local_);
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
    WireEvents* events_ = nullptr;
    net::io_context context_{1};
    Tcp::acceptor tcp_;
    Local::acceptor local_;
    net::steady_timer pause_;
    std::map<ClientId, std::shared_ptr<Connection>> connections_;
    ClientId next_ = 1;
    int port_ = 0;
    std::atomic<double> lag_s_ = 0;
    bool stopping_ = false, bound_ = false;
    std::thread thread_;
};

Network::Network(const NetworkOptions& options) : loop_(std::make_shared<Loop>(options)) {}

Network::~Network() {
    loop_->stop();
}

void Network::start(WireEvents& events) {
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

double Network::lag_s() const {
    return loop_->lag_s();
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
