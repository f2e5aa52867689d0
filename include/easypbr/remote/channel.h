// Channel: a scene's picture for clients whose messages the program itself carries.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace easypbr {

class Animations;
class Scene;
struct Settings;

namespace remote {

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

    /// Ends the drawing. Nothing happens the second time.
    void close();
    bool is_open() const;

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace remote
}  // namespace easypbr
