// Which names a server answers to, and which pages may connect to it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace easypbr::remote {

/// What guards against pages of other sites: a name that resolves to this machine (DNS rebinding), and pages
/// that connect to it from elsewhere.
class HostRules {
  public:
    HostRules() = default;
    /// `bind`: the address that is listened on; `names`: others that the server is reached by, without ports;
    /// `origins`: pages of other sites that may connect, "https://hub.example.org". Throws ArgumentError for
    /// what is no name or origin.
    HostRules(const std::string& bind, const std::vector<std::string>& names,
              const std::vector<std::string>& origins);

    /// The request's Host: loopback, the bound address (of 0.0.0.0 and :: those of addresses_of()) or one of
    /// the names, with any port.
    bool allows_host(std::string_view host) const;
    /// The request's Origin: the request's own host, which is allowed, or one of the origins. None ("") is
    /// what programs send that are no browser.
    bool allows_origin(std::string_view origin, std::string_view host) const;
    /// Origins that may show the page in a frame.
    const std::vector<std::string>& origins() const { return origins_; }

  private:
    std::vector<std::string> names_, origins_;
};

/// The addresses that a server listens on: those of this machine's interfaces for 0.0.0.0 and ::, without
/// loopback, else the one.
std::vector<std::string> addresses_of(const std::string& bind);

/// Whether an address is this machine's alone: 127.0.0.0/8, ::1, localhost.
bool is_loopback(std::string_view name);

}  // namespace easypbr::remote
