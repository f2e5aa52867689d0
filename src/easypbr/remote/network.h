// Network: HTTP and WebSockets on one thread. Who uses it sees neither sockets nor the library behind.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "easypbr/remote/hosts.h"
#include "easypbr/remote/wire.h"

namespace easypbr::remote {

struct NetworkOptions {
    std::string bind = "127.0.0.1";  ///< an address
    int port = 0;                    ///< 0: any that is free
    std::filesystem::path socket;    ///< a Unix socket in place of address and port
    HostRules hosts;
    size_t most_clients = 16;
};

/// Throws ArgumentError for what is no address that can be listened on.
void check_address(const std::string& bind);

class Network : public Wire {
  public:
    /// Listens. Throws ArgumentError for what is no address, FileError for a socket that cannot be made,
    /// Error for a port that is taken.
    explicit Network(const NetworkOptions& options);
    /// Says goodbye to all.
    ~Network() override;
    Network(const Network&) = delete;
    Network& operator=(const Network&) = delete;

    /// Begins to answer. The events must outlive stop().
    void start(WireEvents& events);
    /// Closes all connections; no event comes afterwards.
    void stop();
    /// 0 of a Unix socket.
    int port() const;

    void admit(ClientId client) override;
    void send(ClientId client, SharedText text) override;
    void send(ClientId client, Packet packet) override;
    double lag_s() const override;
    void close(ClientId client, CloseCode code, const std::string& reason, double delay_s) override;

    /// Limits on messages, bytes, and what a client may leave unread.
    static constexpr size_t most_first_bytes = 4096, most_bytes = 64 * 1024,
                            most_unread_bytes = size_t(8) << 20;
    /// Connections that have not shown a token yet; one more takes the place of the oldest.
    static constexpr size_t most_strangers = 32;
    static constexpr int token_s = 5, header_s = 10, idle_s = 30;
    static constexpr uint32_t most_header_bytes = 8 * 1024;

  private:
    class Loop;
    std::shared_ptr<Loop> loop_;
};

}  // namespace easypbr::remote
