// Network: HTTP and WebSockets on one thread. Who uses it sees neither sockets nor the library behind.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/remote/frame_header.h"
#include "easypbr/remote/hosts.h"

namespace easypbr::remote {

using ClientId = uint64_t;
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

struct NetworkOptions {
    std::string bind = "127.0.0.1";  ///< an address
    int port = 0;                    ///< 0: any that is free
    std::filesystem::path socket;    ///< a Unix socket in place of address and port
    HostRules hosts;
    size_t most_clients = 16;
};

/// What happens, told on the network's thread. None may throw.
class NetworkEvents {
  public:
    virtual ~NetworkEvents() = default;
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
class Network {
  public:
    /// Listens. Throws ArgumentError for what is no address, FileError for a socket that cannot be made,
    /// Error for a port that is taken.
    explicit Network(const NetworkOptions& options);
    /// Says goodbye to all.
    ~Network();
    Network(const Network&) = delete;
    Network& operator=(const Network&) = delete;

    /// Begins to answer. The events must outlive stop().
    void start(NetworkEvents& events);
    /// Closes all connections; no event comes afterwards.
    void stop();
    /// 0 of a Unix socket.
    int port() const;

    /// The client has shown its token: larger messages, and no hurry.
    void admit(ClientId client);
    void send(ClientId client, SharedText text);
    void send(ClientId client, Packet packet);
    /// After `delay_s`.
    void close(ClientId client, CloseCode code, const std::string& reason, double delay_s = 0);

    /// Limits on messages, bytes, and what a client may leave unread.
    static constexpr size_t most_first_bytes = 4096, most_bytes = 64 * 1024,
                            most_unread_bytes = size_t(8) << 20;
    /// Connections that have not shown a token yet.
    static constexpr size_t most_strangers = 32;
    static constexpr int token_s = 5, header_s = 10, idle_s = 30;
    static constexpr uint32_t most_header_bytes = 8 * 1024;

  private:
    class Loop;
    std::shared_ptr<Loop> loop_;
};

}  // namespace easypbr::remote
