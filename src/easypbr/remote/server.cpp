#include "easypbr/remote/server.h"

#include <fmt/format.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/core/own_process.h"
#include "easypbr/remote/hosts.h"
#include "easypbr/remote/moving_pictures.h"
#include "easypbr/remote/network.h"
#include "easypbr/remote/served_files.h"
#include "easypbr/remote/views.h"
#include "easypbr/scene/scene.h"
#include "easypbr/scene/settings.h"

namespace easypbr::remote {
namespace {

constexpr int most_own_views = 64;

NetworkOptions network_options(const ServeOptions& options) {
    if (options.port < 0 || options.port > 65535)
        throw ArgumentError(fmt::format("port: expected 0 to 65535, got {}", options.port));
    if (options.max_clients < 1 || options.max_clients > 1000)
        throw ArgumentError(fmt::format("max_clients: expected 1 to 1000, got {}", options.max_clients));
    if (options.own_views < 0 || options.own_views > most_own_views)
        throw ArgumentError(
            fmt::format("own_views: expected 0 to {}, got {}", most_own_views, options.own_views));
    if (options.socket.empty()) check_address(options.bind);
    NetworkOptions network;
    network.bind = options.bind;
    network.port = options.port;
    network.socket = options.socket;
    network.hosts = HostRules(options.bind, options.host_names, options.origins);
    return network;
}

void check_codec(const ServeOptions& options) {
    if (options.codec != "auto" && options.codec != "h264" && options.codec != "jpeg")
        throw ArgumentError(fmt::format("codec '{}': expected auto, h264 or jpeg", options.codec));
}

bool offers_video(const ServeOptions& options) {
    check_codec(options);
    if (options.codec == "jpeg") return false;
    if (options.codec == "auto") return true;
    if (const std::string why = video_refusal(); !why.empty()) throw FormatError(why);
    return true;
}

std::unique_ptr<ServedFiles> served_files(const ServeOptions& options) {
    return options.files.empty() ? nullptr : std::make_unique<ServedFiles>(options.files);
}

void warn_of_strangers(const ServeOptions& options) {
    if (options.socket.empty() && !is_loopback(options.bind))
        log_warning(fmt::format(
            "the address {} is seen by the network, and nothing is encrypted: ssh -L needs no such address. "
            "It is answered to by its addresses; other names of this machine need --host-name (host_names)",
            options.bind));
}

}  // namespace

void check_options(const ServeOptions& options) {
    network_options(options);
    check_codec(options);
}

struct Server::Parts {
    Parts(const Scene& scene, const Settings& settings, const ServeOptions& given)
        : options(given),
          tokens(load_tokens(given.token_file)),
          network(network_options(given)),
          clients(network, inbox, tokens, size_t(given.max_clients), HandOver::when_idle,
                  {size_t(given.own_views), given.own_views_for_watchers}),
          views(scene, settings, inbox, clients, served_files(given)) {
        const std::string session = random_token().substr(0, 16);
        clients.set_welcome(welcome_text(session, false), welcome_text(session, true));
        clients.offer_video(offers_video(given));
        views.start();
        network.start(clients);
    }

    bool is_bound_to_all() const {
        return options.socket.empty() && (options.bind == "0.0.0.0" || options.bind == "::");
    }

    std::string url(const std::string& token) const {
        std::string host = options.socket.empty() ? options.bind : "localhost";
        if (is_bound_to_all()) host = options.host_names.empty() ? "localhost" : options.host_names.front();
        return url(host, token);
    }

    std::string url(std::string host, const std::string& token) const {
        if (host.find(':') != std::string::npos) host = "[" + host + "]";
        const int port = options.socket.empty() ? network.port() : socket_port;
        return fmt::format("http://{}:{}/#token={}", host, port, token);
    }

    /// What a Unix socket is forwarded to.
    static constexpr int socket_port = 8123;

    const OwnProcess process;  ///< of the threads
    const ServeOptions options;
    const Tokens tokens;
    Inbox inbox;
    Network network;
    Clients clients;
    Views views;
    std::mutex closing;
    std::atomic<bool> open = true;
};

Server::Server(const Scene& scene, const Settings& settings, const ServeOptions& options)
    : parts_(std::make_unique<Parts>(scene, settings, options)) {
    warn_of_strangers(options);
}

Server::~Server() {
    if (!parts_->process.is_this()) {
        static_cast<void>(parts_.release());
        return;
    }
    close();
    if (!parts_->views.draws_here()) return;
    // The last one that used it was a panel's function: the thread that it runs on cannot wait for itself.
    std::thread([parts = std::shared_ptr<Parts>(std::move(parts_))] { parts->views.stop(); }).detach();
}

std::string Server::url() const {
    return parts_->url(parts_->tokens.control);
}

std::string Server::watch_url() const {
    return parts_->url(parts_->tokens.watch);
}

std::vector<std::string> Server::urls() const {
    std::vector<std::string> urls = {url()};
    if (parts_->is_bound_to_all())
        for (const std::string& address : addresses_of(parts_->options.bind))
            urls.push_back(parts_->url(address, parts_->tokens.control));
    return urls;
}

std::string Server::forward_command(const std::string& host) const {
    const ServeOptions& options = parts_->options;
    if (!options.socket.empty())
        return fmt::format("ssh -N -L {}:{} {}", Parts::socket_port,
                           std::filesystem::absolute(options.socket).string(), host);
    return fmt::format("ssh -N -L {0}:127.0.0.1:{0} {1}", port(), host);
}

int Server::port() const {
    return parts_->network.port();
}

std::vector<ServerClient> Server::clients() const {
    std::vector<ServerClient> clients;
    if (!is_open()) return clients;
    for (const ClientState& state : parts_->clients.states())
        clients.push_back(
            {state.id, state.controls, state.watches_only, state.latency_s, state.view != shared_view});
    return clients;
}

void Server::take_settings(const Settings& settings) {
    if (is_open()) parts_->views.take_settings(settings);
}

void Server::add_animations(const std::string& name, const Animations& animations) {
    if (is_open()) parts_->views.add_animations(name, animations);
}

void Server::add_panel(const std::string& name, std::function<void(app::Widgets&)> function) {
    if (is_open()) parts_->views.add_panel(name, std::move(function));
}

void Server::remove_panel(const std::string& name) {
    if (is_open()) parts_->views.remove_panel(name);
}

void Server::close() {
    // A panel's function that closes what draws it waits for nobody: whoever closes meanwhile waits for it.
    if (!parts_->process.is_this()) return;
    std::unique_lock lock(parts_->closing, std::defer_lock);
    if (!parts_->views.draws_here()) lock.lock();
    if (parts_->open.exchange(false)) parts_->network.stop();
    parts_->views.stop();
}

bool Server::is_open() const {
    return parts_->open;
}

}  // namespace easypbr::remote
