#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "easypbr/app/output.h"
#include "easypbr/app/session.h"
#include "easypbr/app/settings_files.h"
#include "easypbr/cli/command.h"
#include "easypbr/cli/drawable.h"
#include "easypbr/cli/shown_files.h"
#include "easypbr/core/error.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/remote/server.h"
#include "easypbr/scene/animation.h"
#include "easypbr/scene/settings.h"

namespace easypbr::cli {
namespace {

struct ServeCommand {
    ShownFiles shown;
    std::string socket, token_file, files;
    remote::ServeOptions server;
};

void declare_serve(CLI::App& command, ServeCommand& options) {
    declare_shown_files(command, options.shown);
    command.add_option("--port", options.server.port, "Port to listen on; 0 takes any that is free")
        ->option_text("N");
    command
        .add_option("--bind", options.server.bind,
                    "Address to listen on; others than 127.0.0.1 are seen by the network")
        ->option_text("ADDRESS");
    command
        .add_option("--socket", options.socket,
                    "Listen on a Unix socket that no other user can open, in place of a port")
        ->option_text("PATH");
    command
        .add_option("--token-file", options.token_file,
                    "Secrets to use: a line to control, a line to watch; by default random ones")
        ->option_text("FILE");
    command
        .add_option("--host-name", options.server.host_names,
                    "Another name that the server is reached by; may be repeated")
        ->allow_extra_args(false)
        ->option_text("NAME");
    command
        .add_option("--origin", options.server.origins,
                    "Page of another site that may connect, such as https://hub.example.org; may be repeated")
        ->allow_extra_args(false)
        ->option_text("URL");
    command.add_option("--max-clients", options.server.max_clients, "Clients at a time")->option_text("N");
    command
        .add_option("--codec", options.server.codec,
                    "What moving pictures are sent as: auto takes h264 where both sides have it, else jpeg")
        ->transform(CLI::IsMember({"auto", "h264", "jpeg"}, CLI::ignore_case))
        ->option_text("auto|h264|jpeg");
    command
        .add_option("--own-views", options.server.own_views,
                    "Clients that may have a camera and settings of their own at a time, 0 to 64")
        ->option_text("N");
    command.add_flag("--own-views-for-watchers", options.server.own_views_for_watchers,
                     "Clients that came by the watch link may have one too");
    command
        .add_option(
            "--files", options.files,
            "Folder beneath which clients that control may have files opened, instead of FILE or beside")
        ->option_text("FOLDER");
}

volatile sig_atomic_t stopped = 0;

/// While it lives, Ctrl-C and the like are noted. What was ignored before, as under nohup, still is.
class Signals {
  public:
    Signals() {
        stopped = 0;
        struct sigaction note {};
        note.sa_handler = [](int) { stopped = 1; };
        note.sa_flags = SA_RESTART;
        for (size_t i = 0; i < numbers.size(); ++i) {
            ::sigaction(numbers[i], nullptr, &before_[i]);
            if (before_[i].sa_handler != SIG_IGN) ::sigaction(numbers[i], &note, nullptr);
        }
    }
    ~Signals() {
        for (size_t i = 0; i < numbers.size(); ++i) ::sigaction(numbers[i], &before_[i], nullptr);
    }
    Signals(const Signals&) = delete;
    Signals& operator=(const Signals&) = delete;

  private:
    static constexpr std::array<int, 3> numbers = {SIGINT, SIGTERM, SIGHUP};
    std::array<struct sigaction, 3> before_{};
};

/// This machine's address as the ssh session reached it: the third word of SSH_CONNECTION.
std::string ssh_host() {
    const char* const connection = std::getenv("SSH_CONNECTION");
    if (!connection) return {};
    const std::string words = connection;
    const size_t first = words.find(' '), second = words.find(' ', first + 1);
    const size_t third = words.find(' ', second + 1);
    if (first == words.npos || second == words.npos || third == words.npos) return {};
    return words.substr(second + 1, third - second - 1);
}

void tell_urls(const remote::Server& server) {
    for (const std::string& url : server.urls()) fmt::print("control: {}\n", url);
    fmt::print("watch:   {}\n", server.watch_url());
    if (const std::string host = ssh_host(); !host.empty())
        fmt::print("on your own machine first: {}\n", server.forward_command(host));
    fmt::print("Ctrl-C ends\n");
    std::fflush(stdout);
}

remote::ServeOptions server_options_of(const ServeCommand& options) {
    remote::ServeOptions server = options.server;
    server.socket = options.socket;
    server.token_file = options.token_file;
    server.files = options.files;
    return server;
}

void check_serve(const ServeCommand& options) {
    check_input("serve", options.shown.files);
    require(!options.shown.files.empty() || !options.files.empty(), "serve",
            "at least one FILE, or --files FOLDER");
    check_start(options.shown.start);
    remote::check_options(server_options_of(options));
}

int run_serve(const ServeCommand& options) {
    const ShownFiles& shown = options.shown;
    app::Session session;
    apply(shown.start, session);
    apply(shown_look(shown), session.settings());
    std::vector<std::pair<std::string, Animations>> animations;
    show_files(shown, session, [&](size_t, const std::string& name, const io::LoadedScene& loaded) {
        if (!loaded.animations.empty()) animations.emplace_back(name, loaded.animations);
    });
    const Signals signals;
    remote::Server server(session.scene(), session.settings(), server_options_of(options));
    for (const auto& [name, each] : animations) server.add_animations(name, each);
    tell_urls(server);
    while (!stopped) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    server.close();
    return 0;
}

}  // namespace

void add_serve(CLI::App& app, Job& job) {
    set_job<ServeCommand>(*app.add_subcommand("serve", "Show mesh files in the browsers of other machines"),
                          job, declare_serve, run_serve, check_serve);
}

}  // namespace easypbr::cli
