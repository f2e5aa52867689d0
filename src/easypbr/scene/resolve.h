// Automatic parameters: infers every value that an image needs from a scene and the user's settings.
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "easypbr/scene/camera.h"
#include "easypbr/scene/resolved_light.h"
#include "easypbr/scene/scene.h"
#include "easypbr/scene/settings.h"

namespace easypbr {

/// Parts of a picture's width and height that something covers along its sides, such as a menu bar: 0 to 0.9,
/// together as much along each axis. An automatic camera leaves them free beside its margin.
struct Insets {
    double left = 0, right = 0, top = 0, bottom = 0;
    bool operator==(const Insets&) const = default;

    /// What these or the others cover.
    Insets with(const Insets& other) const {
        return {std::max(left, other.left), std::max(right, other.right), std::max(top, other.top),
                std::max(bottom, other.bottom)};
    }
};

/// All inputs of the renderer from the settings, fully inferred.
struct ResolvedSettings {
    InferredSettings settings;
    bool traces_rays = false;           ///< rays replace ambient occlusion, see RaySettings
    bool traces_single_frames = false;  ///< in a frame that stands for one sample too: the user asks for rays
    bool traces_paths = false;          ///< paths are traced, see PathSettings
    bool asks_for_paths = false;  ///< the user: in single frames too, and scene-linear pictures stay noisy
    Camera camera;
    std::vector<ResolvedLight> lights;         ///< enabled lights of the scene, then key, fill, rim and sun
    std::map<std::string, float> light_radii;  ///< those inferred for lights of the scene, by name
    Environment environment;       ///< environment map without its sun: the given one, the studio, or empty
    Environment seen_environment;  ///< the same with its sun, for the background
    Mat3 R_env_world = Mat3::Identity();  ///< from world space to environment space
    double lens_radius = 0;               ///< of the aperture, world units; 0: a pinhole
    float exposure = 1;                   ///< scale factor before tone mapping, compensation included
};

/// Pure: the same scene, settings, size and samples give the same result. Samples are those that the picture
/// averages, by default image.samples. Throws ArgumentError when settings contradict each other, when there
/// is nothing to place a camera for, and, with its name, when a mesh is so large that the camera or a light
/// leaves single precision.
ResolvedSettings resolve(const SceneSnapshot& scene, const Settings& settings, Vec2i size,
                         std::optional<int> samples = std::nullopt, const Insets& insets = {});

/// Copies inferred values into the automatic (not pinned, not following) fields of `settings` that keep them
/// and hold none yet, but those that are not finite or out of the field's range.
void latch(Settings& settings, const InferredSettings& inferred);
/// Releases all latched values, so that the next image infers them again.
void release(Settings& settings);

/// World direction of an up setting: "+x", "-x", "+y", "-y", "+z", "-z" (F3D's spelling, the sign may be
/// missing).
Vec3d parse_up(const std::string& up);

/// The same of settings; automatic and not inferred yet: +y.
inline Vec3d up_direction(const CameraSettings& settings) {
    return parse_up(settings.up.value_or("+y"));
}

/// Rows: the world's right, up and front for an up direction that is a world axis. The front is where an
/// automatic camera with azimuth 0 stands: +z for +y up, -y for +z up. Turns world directions into a frame
/// with +Y up.
Mat3d up_frame(const Vec3d& up);

/// Axes (columns) of a camera that looks at the content from the settings' azimuth and elevation.
Mat3d view_rotation(const CameraSettings& settings);

/// The camera with these axes that shows all vertices, the limiting dimension filling 1 - margin of the
/// picture, less its insets, exactly (but no vertex is nearer than a hundredth of the content's radius).
/// Projection, angle or intrinsics and margin are those of the settings. Closed form per axis: see "Camera
/// fit" in docs/design/automatic_parameters.md. Throws ArgumentError when there are no vertices.
Camera fit_camera(const SceneSnapshot& scene, const Mat3d& R_world_cam, const CameraSettings& settings,
                  double aspect, const Insets& insets = {});

}  // namespace easypbr
