// What clients send: JSON text, read by a strict schema into values. Nothing here knows a socket.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "easypbr/app/input.h"
#include "easypbr/core/error.h"
#include "easypbr/core/math.h"

namespace easypbr::remote {

/// A message that cannot be understood; the text says why. It ends the connection.
class ProtocolError : public Error {
  public:
    using Error::Error;
};

/// Largest side of a picture that a client may ask for, of the live view and of a still.
inline constexpr int most_live_side = 4096, most_shot_side = 16384;
/// Pixels of a still at most.
inline constexpr int64_t most_shot_pixels = int64_t(1) << 26;

/// The first message of every connection.
struct Hello {
    std::string token;
    Vec2i size{1, 1};  ///< of the client's canvas, pixels
};
/// A picture, or a chunk of one, has been drawn on the client's canvas.
struct Ack {
    uint32_t frame = 0;
    uint32_t chunk = 0;
    double busy_s = 0;  ///< from its arrival in the page to its being drawn
};
/// What mouse, touch and keys did; `id` grows, pictures name the last one that they show.
struct Input {
    uint32_t id = 0;
    app::InputEvent event;
};
/// Turns the camera about its target.
struct Turn {
    uint32_t id = 0;
    double right_deg = 0, up_deg = 0;
};
struct Resize {
    Vec2i size{1, 1};
};
/// Asks for an own camera and settings of the same scene, or for the shared ones again.
struct OwnView {
    bool own = false;
    Vec2i size{1, 1};  ///< of the client's canvas, pixels
};
/// A client that cannot be seen asks for no pictures.
struct Pause {
    bool paused = false;
};
/// Whether the client decodes H.264. One that does says so again when it has lost its place in the video.
struct Decodes {
    bool h264 = false;
};
/// A setting as it is written on the command line.
struct SetField {
    std::string name, value;
};
/// Has an object and its children be drawn or not.
struct ShowObject {
    std::string object;
    bool visible = true;
};
struct Select {
    std::string object;
};
/// What is seen in a pixel.
struct PickAt {
    uint32_t id = 0;
    Vec2d pixel{0, 0};
};
struct SetChannel {
    std::string name;
};
/// A still of any size.
struct Shot {
    uint32_t id = 0;
    Vec2i size{1, 1};
};
/// See app::camera_text().
struct SetCamera {
    std::string text;
};
/// Something done to a widget of a panel: of those of the same name the one after `use` others.
struct SetWidget {
    bool tool = false;  ///< of a panel of ToolPanels, else of the program's
    std::string panel, name;
    uint32_t use = 0;
    std::string value;  ///< a number, "true" or "false", "#rrggbb", or text; of a button nothing
};
/// Plays an animation of the files that are served.
struct Animate {
    uint32_t number = 0;
    bool plays = false;
    double time_s = 0, speed = 1;
};
struct Act {
    enum class What { fit, undo, redo, take_control, leave_control, reset } what = What::fit;
};

using ClientMessage =
    std::variant<Hello, Ack, Input, Turn, Resize, OwnView, Pause, Decodes, SetField, ShowObject, Select,
                 PickAt, SetChannel, Shot, SetCamera, SetWidget, Animate, Act>;

/// Throws ProtocolError for text that is no JSON object, of an unknown kind, or whose members are missing,
/// unknown, of another type, not finite or out of range.
ClientMessage parse_message(std::string_view text);

}  // namespace easypbr::remote
