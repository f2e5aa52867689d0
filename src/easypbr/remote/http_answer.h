// What the server says to a request that is no message: the page's files, or why not. Knows no socket.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "easypbr/remote/hosts.h"

namespace easypbr::remote {

/// Of the one WebSocket: the last part of its path, and the protocol that is spoken.
inline constexpr std::string_view socket_name = "socket", protocol_name = "easypbr.1";

struct HttpRequest {
    std::string_view method, target, host, origin, protocols;
    bool upgrade = false;  ///< to a WebSocket
    int hosts = 1;         ///< how often the header stands there
};

struct HttpAnswer {
    int status = 200;
    std::string_view type = "text/plain; charset=utf-8";
    std::string_view body;
    bool is_socket = false;  ///< nothing is wrong: the WebSocket may begin
};

/// Decides about a request. A table of embedded names is all that there is: no file is opened. Paths count
/// from their last "/", so that the page may be below any prefix.
HttpAnswer answer(const HttpRequest& request, const HostRules& hosts);

/// Headers that every answer carries: no other site's scripts, nothing kept, nothing guessed.
std::vector<std::pair<std::string, std::string>> safety_headers(const HostRules& hosts);

}  // namespace easypbr::remote
