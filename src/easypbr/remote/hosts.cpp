#include "easypbr/remote/hosts.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <netinet/in.h>

#include <algorithm>
#include <memory>

#include "easypbr/core/ascii.h"
#include "easypbr/core/error.h"

namespace easypbr::remote {
namespace {

constexpr size_t longest_name = 253;

bool is_port(std::string_view text) {
    return !text.empty() && text.size() <= 5 && std::ranges::all_of(text, ascii::is_digit);
}

/// "name" of "name", "name:port", "[::1]" and "[::1]:port"; empty for what is none of these.
std::string name_of(std::string_view host) {
    if (host.size() > longest_name + 8) return {};
    if (host.starts_with('[')) {
        const size_t end = host.find(']');
        if (end == host.npos) return {};
        const std::string_view rest = host.substr(end + 1);
        if (!rest.empty() && !(rest[0] == ':' && is_port(rest.substr(1)))) return {};
        return ascii::to_lower(host.substr(1, end - 1));
    }
    const size_t colon = host.find(':');
    if (colon == host.npos) return ascii::to_lower(host);
    return is_port(host.substr(colon + 1)) ? ascii::to_lower(host.substr(0, colon)) : std::string();
}

bool is_name(std::string_view name) {
    const auto fits = [](char c) {
        return ascii::is_alnum(c) || c == '-' || c == '.' || c == ':' || c == '_';
    };
    return !name.empty() && name.size() <= longest_name && std::ranges::all_of(name, fits);
}

/// The host of "http://host" or "https://host", port included; empty for other texts.
std::string_view host_of(std::string_view origin) {
    for (const std::string_view scheme : {"http://", "https://"})
        if (origin.starts_with(scheme)) return origin.substr(scheme.size());
    return {};
}

std::string checked_origin(std::string origin) {
    origin = ascii::to_lower(origin);
    if (!is_name(name_of(host_of(origin))))
        throw ArgumentError(
            fmt::format("origin '{}': expected such as https://hub.example.org, without a path", origin));
    return origin;
}

/// An interface's address as it stands in a link; empty for those of loopback, of a link alone (fe80::) and
/// of other families.
std::string interface_text(const sockaddr* address, bool with_v6) {
    char text[INET6_ADDRSTRLEN] = "";
    if (address && address->sa_family == AF_INET) {
        inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(address)->sin_addr, text, sizeof text);
    } else if (address && address->sa_family == AF_INET6 && with_v6) {
        const in6_addr& v6 = reinterpret_cast<const sockaddr_in6*>(address)->sin6_addr;
        if (!IN6_IS_ADDR_LINKLOCAL(&v6)) inet_ntop(AF_INET6, &v6, text, sizeof text);
    }
    return is_loopback(text) ? "" : text;
}

}  // namespace

std::vector<std::string> addresses_of(const std::string& bind) {
    if (bind != "0.0.0.0" && bind != "::") return {bind};
    ifaddrs* first = nullptr;
    if (getifaddrs(&first) != 0) return {};
    const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> interfaces(first, freeifaddrs);
    std::vector<std::string> addresses;
    for (const ifaddrs* each = first; each; each = each->ifa_next)
        if (std::string text = interface_text(each->ifa_addr, bind == "::");
            !text.empty() && std::ranges::find(addresses, text) == addresses.end())
            addresses.push_back(std::move(text));
    return addresses;
}

bool is_loopback(std::string_view name) {
    const auto digits_and_dots = [](char c) { return ascii::is_digit(c) || c == '.'; };
    return name == "localhost" || name == "::1" ||
           (name.starts_with("127.") && std::ranges::count(name, '.') == 3 &&
            std::ranges::all_of(name, digits_and_dots));
}

HostRules::HostRules(const std::string& bind, const std::vector<std::string>& names,
                     const std::vector<std::string>& origins) {
    if (!bind.empty()) names_.push_back(ascii::to_lower(bind));
    // No name of somebody else's resolves to an address that the browser was given as such.
    for (const std::string& address : addresses_of(bind)) names_.push_back(ascii::to_lower(address));
    for (const std::string& name : names) {
        if (!is_name(name) || name_of(name.find(':') == name.npos ? name : "[" + name + "]").empty())
            throw ArgumentError(fmt::format("host name '{}': expected a name without a port", name));
        names_.push_back(ascii::to_lower(name));
    }
    for (const std::string& origin : origins) origins_.push_back(checked_origin(origin));
}

bool HostRules::allows_host(std::string_view host) const {
    const std::string name = name_of(host);
    return is_name(name) && (is_loopback(name) || std::ranges::find(names_, name) != names_.end());
}

bool HostRules::allows_origin(std::string_view origin, std::string_view host) const {
    if (origin.empty()) return true;
    const std::string given = ascii::to_lower(origin);
    if (std::ranges::find(origins_, given) != origins_.end()) return true;
    const std::string_view own = host_of(given);
    return allows_host(own) && own == ascii::to_lower(host);
}

}  // namespace easypbr::remote
