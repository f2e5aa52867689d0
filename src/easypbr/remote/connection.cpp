#include "easypbr/remote/connection.h"

#include <chrono>

namespace easypbr::remote {
namespace {

using std::chrono::seconds;

std::string_view view_of(beast::string_view text) {
    return {text.data(), text.size()};
}

void add_safety(auto& message, const HostRules& hosts) {
    for (const auto& [name, value] : safety_headers(hosts)) message.set(name, value);
    message.set(http::field::server, "easypbr");
}

size_t bytes_of_item(const Connection::Item& item) {
    const auto* packet = std::get_if<Packet>(&item);
    return packet ? FrameHeader::size + packet->count : std::get<SharedText>(item)->size();
}

}  // namespace

Connection::Connection(Stream stream, ClientId id, Owner& owner)
    : socket_(std::move(stream)), id_(id), owner_(&owner), deadline_(socket_.get_executor()) {}

void Connection::start() {
    parser_.header_limit(Network::most_header_bytes);
    parser_.body_limit(uint64_t(0));
    stream().expires_after(seconds(Network::header_s));
    http::async_read_header(stream(), buffer_, parser_,
                            [self = shared_from_this()](Code error, size_t) { self->on_request(error); });
}

void Connection::admit() {
    stranger_ = false;
    deadline_.cancel();
    socket_.read_message_max(Network::most_bytes);
}

void Connection::send(Item item) {
    if (closing_ || !open_) return;
    unread_ += bytes_of_item(item);
    queue_.push_back(std::move(item));
    if (unread_ > Network::most_unread_bytes) return close(CloseCode::refused, "reads too slowly");
    if (!writing_) write();
}

void Connection::close(CloseCode code, const std::string& reason) {
    if (std::exchange(closing_, true) || !open_) return;
    const websocket::close_reason why{websocket::close_code(uint16_t(code)), reason.substr(0, 120)};
    socket_.async_close(why, [self = shared_from_this()](Code) { self->end(); });
}

void Connection::close_later(CloseCode code, const std::string& reason, double delay_s) {
    deadline_.expires_after(std::chrono::milliseconds(int(delay_s * 1000)));
    deadline_.async_wait([self = shared_from_this(), code, reason](Code error) {
        if (!error) self->close(code, reason);
    });
}

void Connection::drop() {
    owner_ = nullptr;
    stop_all();
}

void Connection::on_request(Code error) {
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

void Connection::respond(const HttpAnswer& answer, bool head) {
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

void Connection::accept() {
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

void Connection::on_accepted(Code error) {
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

void Connection::read() {
    socket_.async_read(buffer_, [self = shared_from_this()](Code error, size_t) { self->on_message(error); });
}

void Connection::on_message(Code error) {
    if (error || !owner_) return end();
    if (!socket_.got_text())
        close(CloseCode::refused, "expected text");
    else if (!closing_)
        owner_->received(id_, {static_cast<const char*>(buffer_.data().data()), buffer_.size()});
    buffer_.clear();
    read();
}

void Connection::write() {
    writing_ = true;
    const Item& item = queue_.front();
    // One type of buffers for both kinds, so that the writing of messages is compiled once.
    std::array<net::const_buffer, 2> parts;
    const auto* packet = std::get_if<Packet>(&item);
    if (packet) {
        header_ = packet->header.encoded();
        parts = {net::const_buffer(header_.data(), header_.size()),
                 net::const_buffer(packet->bytes->data() + packet->from, packet->count)};
    } else {
        parts[0] = net::buffer(*std::get<SharedText>(item));
    }
    socket_.binary(packet != nullptr);
    socket_.async_write(parts, [self = shared_from_this()](Code error, size_t) { self->on_written(error); });
}

void Connection::on_written(Code error) {
    if (error) return end();
    unread_ -= bytes_of_item(queue_.front());
    queue_.pop_front();
    writing_ = false;
    if (!queue_.empty() && !closing_) write();
}

void Connection::stop_all() {
    deadline_.cancel();
    // A forked child that holds a copy of the socket would keep the other side waiting.
    Code ignored;
    stream().socket().shutdown(net::socket_base::shutdown_both, ignored);
    stream().close();
}

void Connection::end() {
    stop_all();
    if (Owner* owner = std::exchange(owner_, nullptr)) owner->closed(id_);
}

}  // namespace easypbr::remote
