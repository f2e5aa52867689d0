// Auto parameters: from a scene and the user's settings to every value that a picture needs.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "easypbr/scene/camera.h"
#include "easypbr/scene/scene.h"
#include "easypbr/scene/settings.h"

namespace easypbr {

/// All that the renderer asks of the settings, with nothing left to infer.
struct ResolvedSettings {
    Settings settings;  ///< every automatic field holds its value, but overrides of materials and styles, and
                        ///< what is inferred for every picture anew: the next three
    int bloom_levels = 1;
    bool suppress_fireflies = false;
    double focus_distance = 1;  ///< of the depth of field
    Camera camera;
    std::vector<Light> lights;                 ///< enabled lights of the scene, then key, fill, rim and sun
    std::map<std::string, float> light_radii;  ///< those inferred for lights of the scene, by name
    Environment environment;  ///< what lights the scene: the given one, less its sun, the studio, or empty
    Environment seen_environment;         ///< the same with its sun, as it is seen in the background
    Mat3 R_env_world = Mat3::Identity();  ///< turns a world direction into the environment's frame
    double lens_radius = 0;               ///< of the aperture, world units; 0: a pinhole
    float exposure = 1;  ///< factor from radiance to the tone curve's input, compensation included
};

/// Pure: the same scene, settings and size give the same result. Throws ArgumentError when settings
/// contradict each other, when there is nothing to place a camera for, and, with its name, when a mesh is so
/// large that the camera or a light leaves single precision.
ResolvedSettings resolve(const SceneSnapshot& scene, const Settings& settings, Vec2i size);

/// Copies inferred values into the automatic (not pinned, not following) fields of `settings`, but those that
/// are not finite or out of the field's range.
void latch(Settings& settings, const Settings& resolved);
/// Forgets all latched values, so that the next picture infers them anew.
void release(Settings& settings);

/// World direction of an up setting: "+x", "-x", "+y", "-y", "+z", "-z" (F3D's spelling, the sign may be
/// missing).
Vec3d parse_up(const std::string& up);

/// Rows: the world's right, up and front for an up direction that is a world axis. The front is where an
/// automatic camera with azimuth 0 stands: +z for +y up, -y for +z up. Turns world directions into a frame
/// with +Y up.
Mat3d up_frame(const Vec3d& up);

/// Axes (columns) of a camera that looks at the content from the settings' azimuth and elevation.
Mat3d view_rotation(const CameraSettings& settings);

/// The camera with these axes that shows all vertices, the limiting dimension filling 1 - margin of the
/// picture exactly (but no vertex is nearer than a hundredth of the content's radius). Projection, angle or
/// intrinsics and margin are those of the settings. Closed form per axis: see "Camera fit" in
/// docs/design/automatic_parameters.md. Throws ArgumentError when there are no vertices.
Camera fit_camera(const SceneSnapshot& scene, const Mat3d& R_world_cam, const CameraSettings& settings,
                  double aspect);

}  // namespace easypbr
