// A connection of the network. Only this header, connection.cpp and network.cpp see Boost and sockets.
#pragma once

#include <utility>  // Before Asio 1.74, which uses std::exchange without it.

#include <array>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "easypbr/remote/http_answer.h"
#include "easypbr/remote/network.h"

namespace easypbr::remote {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Code = boost::system::error_code;
using Stream = beast::basic_stream<net::generic::stream_protocol>;

/// What a connection tells the loop that owns it.
class Owner {
  public:
    virtual ~Owner() = default;
    virtual void opened(ClientId client) = 0;
    virtual void received(ClientId client, std::string_view text) = 0;
    virtual void closed(ClientId client) = 0;
    virtual const HostRules& hosts() const = 0;
};

/// A connection, from its request to its end. All members are called on the loop's thread.
class Connection : public std::enable_shared_from_this<Connection> {
  public:
    using Item = std::variant<SharedText, Packet>;

    Connection(Stream stream, ClientId id, Owner& owner);

    /// Reads the request.
    void start();
    /// Whether it has not shown its token yet.
    bool is_stranger() const { return stranger_; }
    void admit();
    /// Closes it when too much is unread.
    void send(Item item);
    void close(CloseCode code, const std::string& reason);
    void close_later(CloseCode code, const std::string& reason, double delay_s);
    /// Without a goodbye. The owner hears nothing any more.
    void drop();

  private:
    Stream& stream() { return socket_.next_layer(); }
    void on_request(Code error);
    void respond(const HttpAnswer& answer, bool head);
    void accept();
    void on_accepted(Code error);
    void read();
    void on_message(Code error);
    void write();
    void on_written(Code error);
    void stop_all();
    void end();

    /// Without permessage-deflate, which pictures gain nothing from and which compiles for long.
    websocket::stream<Stream, false> socket_;
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

}  // namespace easypbr::remote
