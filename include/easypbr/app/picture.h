// What to draw, moments to compare with, what lies under a pixel, and how images are shown: plain values.
#pragma once

#include <optional>
#include <string>

#include "easypbr/core/math.h"
#include "easypbr/core/picture.h"
#include "easypbr/scene/camera.h"
#include "easypbr/scene/colormap.h"
#include "easypbr/scene/scene.h"

namespace easypbr::app {

using easypbr::Encoding;

/// What to draw; a value that is not given comes from the settings.
struct PictureOptions {
    std::optional<Vec2i> size;
    std::optional<int> samples;
    Encoding encoding = Encoding::srgb8;
};

/// A moment that surfaces are drawn of instead of the session's own.
struct Moment {
    SceneSnapshot scene;
    Camera camera;
};

/// What lies under a pixel.
struct Pick {
    std::string object;  ///< name in the scene, "car/wheel" for a child
    std::string part;    ///< name of the part of the mesh, empty where it has none and for points
    int part_index = -1;
    bool is_face = true;      ///< else a vertex: of a point, a surfel or a voxel
    int element = -1;         ///< index of the face or vertex in the object's own data; the first in a voxel
    Vec3d position{0, 0, 0};  ///< world, in the scene's frame
    double depth = 0;         ///< along the optical axis
};

/// A page of pictures from all around, which is turned without a server.
struct OrbitPageOptions {
    int columns = 36;                ///< pictures around the up axis, 1 to 360
    int rows = 3;                    ///< elevations, 1 to 60; the camera's own is one of them
    double row_step_deg = 20;        ///< between rows, above 0; all rows lie within 160 degrees
    std::optional<Vec2i> size = {};  ///< none: the settings'
    std::optional<int> samples = {};
    std::string format = "webp";  ///< of the pictures: "webp" or "jpeg"
    int quality = 85;             ///< of the pictures at most, 1 to 100
    double most_megabytes = 20;   ///< of the file, 10^6 bytes each
    std::string title = {};       ///< empty: the names of the objects
};

/// What a line drawing shows of the lines that faces hide.
enum class HiddenLines { none, dashed, solid };

/// The visible and the hidden edges of a scene as vector graphics; settings.outline has width, colour, kinds
/// of edges and the angle of creases.
struct LineDrawingOptions {
    std::optional<Vec2i> size = {};  ///< none: the settings'
    HiddenLines hidden = HiddenLines::dashed;
};

/// How an image is shown beside the scene. Its values are shown as they are: no curve is applied.
struct ImageLook {
    std::optional<float> min, max;  ///< black and white; none: 0 to 255 of u8, 0 to 65535 of u16, 0 to 1 of
                                    ///< f32 in colour, all finite values of f32 with one channel
    std::optional<Colormap> colormap;  ///< of one channel; none: grey, of f32 viridis
};

}  // namespace easypbr::app
