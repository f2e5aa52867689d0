// Wire: what brings messages to clients. Who uses it knows no socket.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/remote/frame_header.h"

namespace easypbr::remote {

using ClientId = uint64_t;
/// Which camera and settings pictures are drawn with.
using ViewId = uint16_t;
/// All clients see it until they ask for a view of their own.
inline constexpr ViewId shared_view = 0;
using SharedText = std::shared_ptr<const std::string>;
using SharedBytes = std::shared_ptr<const std::vector<std::byte>>;

/// Why a connection is closed, as WebSockets number it.
enum class CloseCode : uint16_t {
    going_away = 1001,
    refused = 1008,
    too_big = 1009,
    full = 1013,
    wrong_token = 4001
};

/// What happens, told on the wire's thread. None may throw.
class WireEvents {
  public:
    virtual ~WireEvents() = default;
    virtual void opened(ClientId client) = 0;
    virtual void received(ClientId client, std::string_view text) = 0;
    virtual void closed(ClientId client) = 0;
};

/// A part of a picture on its way: a header and bytes [from, from + count) of what many clients share.
struct Packet {
    FrameHeader header;
    SharedBytes bytes;
    size_t from = 0, count = 0;
};

/// All members may be called from any thread; those that name a client that has gone do nothing.
class Wire {
  public:
    virtual ~Wire() = default;
    /// The client has shown its token: larger messages, and no hurry.
    virtual void admit(ClientId client) = 0;
    virtual void send(ClientId client, SharedText text) = 0;
    virtual void send(ClientId client, Packet packet) = 0;
    /// How late the wire's own thread has lately been for what it was given, because the machine is busy.
    virtual double lag_s() const { return 0; }
    /// After `delay_s`.
    virtual void close(ClientId client, CloseCode code, const std::string& reason, double delay_s = 0) = 0;
};

}  // namespace easypbr::remote
