#include "easypbr/remote/http_answer.h"

#include <fmt/format.h>

#include "easypbr/remote/page.h"

namespace easypbr::remote {
namespace {

HttpAnswer refusal(int status, std::string_view why) {
    HttpAnswer answer;
    answer.status = status;
    answer.body = why;
    return answer;
}

/// What follows the last "/" of a path, without "?query".
std::string_view last_name(std::string_view target) {
    target = target.substr(0, target.find('?'));
    return target.substr(target.rfind('/') + 1);
}

/// Whether "a, b" names the protocol.
bool speaks(std::string_view protocols) {
    while (!protocols.empty()) {
        const size_t comma = std::min(protocols.find(','), protocols.size());
        std::string_view one = protocols.substr(0, comma);
        while (one.starts_with(' ')) one.remove_prefix(1);
        while (one.ends_with(' ')) one.remove_suffix(1);
        if (one == protocol_name) return true;
        protocols.remove_prefix(std::min(comma + 1, protocols.size()));
    }
    return false;
}

HttpAnswer socket_answer(const HttpRequest& request, const HostRules& hosts) {
    if (!request.upgrade) return refusal(426, "this is a WebSocket\n");
    if (!hosts.allows_origin(request.origin, request.host))
        return refusal(403, "pages of this origin may not connect: see --origin\n");
    if (!speaks(request.protocols)) return refusal(400, "expected the protocol easypbr.1\n");
    HttpAnswer answer;
    answer.is_socket = true;
    return answer;
}

}  // namespace

HttpAnswer answer(const HttpRequest& request, const HostRules& hosts) {
    if (request.hosts != 1 || !hosts.allows_host(request.host))
        return refusal(403, "this server does not answer to that name: see --host-name\n");
    if (request.method != "GET" && request.method != "HEAD") return refusal(405, "expected GET or HEAD\n");
    if (!request.target.starts_with('/')) return refusal(400, "expected a path\n");
    const std::string_view name = last_name(request.target);
    if (name == socket_name) return socket_answer(request, hosts);
    const PageFile* file = page_file(name.empty() ? "index.html" : name);
    if (!file) return refusal(404, "there is no such file\n");
    HttpAnswer answer;
    answer.type = file->type;
    answer.body = file->content;
    return answer;
}

std::vector<std::pair<std::string, std::string>> safety_headers(const HostRules& hosts) {
    std::string frames = "'self'";
    for (const std::string& origin : hosts.origins()) frames += " " + origin;
    const std::string policy = fmt::format(
        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' blob:; "
        "worker-src blob:; base-uri 'none'; form-action 'none'; frame-ancestors {}",
        frames);
    return {{"Content-Security-Policy", policy},
            {"X-Content-Type-Options", "nosniff"},
            {"Referrer-Policy", "no-referrer"},
            {"Cache-Control", "no-store"},
            {"Cross-Origin-Resource-Policy", "same-origin"},
            {"Permissions-Policy", "camera=(), microphone=(), geolocation=()"}};
}

}  // namespace easypbr::remote
