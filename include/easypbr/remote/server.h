// Server: a scene's picture in the browsers of other machines; Channel: for clients whose messages the
// program itself carries, such as the widgets of a notebook.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/core/error.h"

namespace easypbr {

class Animations;
class Scene;
struct Settings;

namespace app {
class Widgets;
}

namespace remote {

struct ServeOptions {
    int port = 0;  ///< 0 to 65535; 0: any that is free
    std::string bind =
        "127.0.0.1";  ///< the address that is listened on; others than loopback are seen by the network
    std::filesystem::path socket;  ///< a Unix socket of mode 0600 in place of address and port
    std::filesystem::path
        token_file;  ///< secrets to use: a line to control, a line to watch; empty: random ones
    std::vector<std::string> host_names;  ///< names that the server is reached by beside loopback and `bind`
    std::vector<std::string>
        origins;           ///< pages of other sites that may connect or show it: "https://hub.org"
    int max_clients = 16;  ///< 1 to 1000
    /// What moving pictures are sent as: "auto" (H.264 where FFmpeg's libraries and a client's browser have
    /// it, else JPEG), "jpeg", or "h264" (to those who decode it; an error where it cannot be made).
    std::string codec = "auto";
    /// Clients that may have a camera and settings of their own at a time, of the same scene: 0 to 64. Each
    /// takes up to 48 MB at 1280x720.
    int own_views = 4;
    bool own_views_for_watchers = false;  ///< those who came by watch_url() may have one too
    /// A folder beneath which who controls the shared view may have files opened; empty: none. Nothing
    /// outside of it is read, whatever links and files name. Formats that assimp reads are left out.
    std::filesystem::path files;
};

/// Throws ArgumentError for options out of range, whatever files and this machine hold.
void check_options(const ServeOptions& options);

struct ServerClient {
    uint64_t id = 0;
    bool controls = false;  ///< the shared view, or its own
    bool watches_only = false;
    double latency_s = 0;  ///< from sending a picture to its being drawn; 0 before the first
    bool has_own = false;  ///< looks through a camera of its own
};

/// Answers on a thread of its own, and draws on another one, in a context of its own: the program goes on,
/// and what it changes in the scene is seen. Members may be called from any thread.
class Server {
  public:
    /// Shows the scene with these settings. Throws ArgumentError for options out of range, FileError and
    /// FormatError for the token file, the socket and the folder of files, FormatError for a codec that is
    /// not there, Error when the port is taken.
    Server(const Scene& scene, const Settings& settings, const ServeOptions& options = {});
    /// Closes.
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// With the secret that lets a client in: "http://127.0.0.1:8123/#token=...". Of a Unix socket the name
    /// is "localhost", for the port that it is forwarded to.
    std::string url() const;
    /// url(), and the same at each address of this machine when all are listened on (0.0.0.0, ::).
    std::vector<std::string> urls() const;
    /// Lets a client watch and nothing else.
    std::string watch_url() const;
    /// The command that makes a remote server's port, or socket, reachable on one's own machine.
    std::string forward_command(const std::string& host) const;
    int port() const;

    std::vector<ServerClient> clients() const;

    /// Changes for the clients what has changed in the settings since the last call, and nothing else.
    void take_settings(const Settings& settings);
    /// Lets clients play a file's animations. They then move the meshes of the scene.
    void add_animations(const std::string& name, const Animations& animations);
    /// A panel of the program's own in the clients' pages. `function` is called on the drawing thread, some
    /// ten times a second while somebody is connected, and each time that something was done to the panel;
    /// what it throws is shown there. Clients share it. A panel of the same name is replaced. Throws
    /// ArgumentError for a name without letters.
    void add_panel(const std::string& name, std::function<void(app::Widgets&)> function);
    /// Nothing happens when there is none.
    void remove_panel(const std::string& name);

    /// Says goodbye to all clients, frees the port and waits for the end of the drawing; a panel's function,
    /// which the drawing calls, does not wait: the next call or the destructor does.
    void close();
    bool is_open() const;

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// For one client: words, a part of a picture with its header, or goodbye.
struct ChannelMessage {
    uint64_t client = 0;
    std::string text;              ///< JSON, or why the client is sent away
    std::vector<std::byte> bytes;  ///< empty for words
    int close_code = 0;            ///< above 0: the client is gone, as WebSockets number the reason
};

/// Draws on a thread and in a context of its own, for clients that are all one person's: who sends an input
/// controls. Nobody is asked for a secret: who can reach the program's own wire is let in. Members may be
/// called from any thread.
class Channel {
  public:
    Channel(const Scene& scene, const Settings& settings);
    /// Closes.
    ~Channel();
    Channel(const Channel&) = delete;
    Channel& operator=(const Channel&) = delete;

    /// What a client has sent; the first of a new one begins it. Empty text tells that it is still there: one
    /// that was not heard of for three minutes is gone.
    void receive(uint64_t client, std::string_view text);
    /// The client is gone.
    void leave(uint64_t client);
    /// What is to be sent, in this order; waits until there is something, close() is called, or the time is
    /// over.
    std::vector<ChannelMessage> take(double seconds);
    size_t client_count() const;

    /// Changes for the clients what has changed in the settings since the last call, and nothing else.
    void take_settings(const Settings& settings);
    /// Lets clients play a file's animations. They then move the meshes of the scene.
    void add_animations(const std::string& name, const Animations& animations);
    /// A panel of the program's own in the clients' pages. `function` is called on the drawing thread, some
    /// ten times a second while somebody is connected, and each time that something was done to the panel;
    /// what it throws is shown there. Clients share it. A panel of the same name is replaced. Throws
    /// ArgumentError for a name without letters.
    void add_panel(const std::string& name, std::function<void(app::Widgets&)> function);
    /// Nothing happens when there is none.
    void remove_panel(const std::string& name);

    /// Ends the drawing and waits for that; a panel's function, which the drawing calls, does not wait: the
    /// next call or the destructor does.
    void close();
    bool is_open() const;

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace remote
}  // namespace easypbr
