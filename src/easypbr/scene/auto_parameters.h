// The parts of resolve(): each fills the automatic fields of one group of settings. Lengths enter only as
// multiples of the content's own, so that a scaled scene gives exactly the scaled result.
#pragma once

#include <optional>
#include <vector>

#include "easypbr/scene/near_plane.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::detail {

/// Bounds of what is shown, computed when they are first asked for: with everything latched nobody asks.
class Content {
  public:
    /// As it is drawn with a style's overrides.
    Content(const SceneSnapshot& scene, const Style& overrides);
    Content(const Content&) = delete;
    Content& operator=(const Content&) = delete;

    const SceneSnapshot& scene() const { return styled_ ? *styled_ : scene_; }
    const Style& overrides() const { return overrides_; }
    bool empty() const;
    /// Centre of the bounding box; the origin when empty.
    Vec3d centre() const;
    /// Half the diagonal of the bounding box. Never zero: a single point's distance from the origin stands
    /// in, or 1.
    double radius() const;
    /// Smallest and largest product of the direction with a corner of the bounding box; not for empty
    /// content.
    std::pair<double, double> extent_along(const Vec3d& direction) const;
    /// Empty when there are no vertices.
    const Box3d& bounds() const;

  private:
    const SceneSnapshot& scene_;
    const Style overrides_;
    std::optional<SceneSnapshot> styled_;  ///< where the overrides change how far objects reach
    mutable std::optional<Box3d> bounds_;
};

/// Gives an automatic or following setting its inferred value; a pinned or latched value stays.
template <class T>
void fill(Auto<T>& setting, const T& inferred) {
    if (setting.is_follow())
        setting = Auto<T>(inferred);
    else if (!setting.value())
        setting.latch(inferred);
}

/// The world axis that points up, as a setting says it: what the formats of the content's files say; else +z
/// of a height field; else the axis of the ground that the content clearly stands on; else "+y". The same for
/// content of the same arrays and poses.
std::string inferred_up(const SceneSnapshot& scene);

/// Whether content is clearly a height field z = f(x, y) over a rectangle: vertices on a regular grid, or
/// faces of one side that cover the rectangle once.
bool is_height_field(const SceneSnapshot& scene);

/// Where an automatic camera stands around the content, as camera.azimuth_deg and elevation_deg say it.
struct ViewAngles {
    float azimuth_deg, elevation_deg;
};
inline constexpr ViewAngles usual_view{30, 15};

/// Where the camera stood of the depth images that the content is, if they agree within 10 degrees; else the
/// usual view.
ViewAngles inferred_view(const SceneSnapshot& scene, const Vec3d& up);

/// Projection, angle or intrinsics of the settings, without a pose. Throws ArgumentError for bad intrinsics.
Camera lens_of(const CameraSettings& settings);

/// The picture that content is fitted into.
struct PictureShape {
    double aspect = 1;
    Insets insets = {};
};

/// How far the picture, less its insets and its margin, reaches to each side: of half its width or height.
struct Edges {
    double right, left, top, bottom;
};
Edges edges_of(const PictureShape& picture, double margin);

/// Position with the given axes that frames the content, as fit_camera(). An orthographic picture is
/// `ortho_height` high; nothing: as high as the content needs.
Vec3d fitted_position(const Content& content, const Mat3d& R_world_cam, const Camera& lens, double margin,
                      const PictureShape& picture, std::optional<double> ortho_height);

/// Distance from `target`, along the camera's z, at which all vertices are in the picture.
double fitted_distance(const Content& content, const Vec3d& target, const Mat3d& R_world_cam,
                       const Camera& lens, double margin, const PictureShape& picture);

/// World height of an orthographic picture around the optical axis that shows all vertices.
double fitted_height(const Content& content, const Eigen::Isometry3d& T_world_cam, double margin,
                     const PictureShape& picture);

Camera resolve_camera(const Content& content, CameraSettings& settings, const PictureShape& picture);

/// Height of a ground just below the content, so that a floor of its own hides it. Infinite where there is no
/// content.
double ground_below(const Box3d& content, const Vec3d& up);

/// The radii of lights of the scene that name none: the same part of the content for all, less where points
/// and spots are near a surface, which the emitter must not reach through.
std::vector<float> plain_light_radii(const Content& content, const std::vector<Light>& lights);

/// How far the nearest surface is from a place: `farthest` where there is none within it.
double clear_way(const Content& content, const Vec3d& place, double farthest);

/// Content that closes around the camera: no light from outside reaches what it sees.
struct Enclosure {
    double distance;  ///< of what the camera sees
    Vec3d viewed;     ///< the place in front of the camera at that distance
    double clear;     ///< how far the nearest surface is from the camera: `distance` at most
};
std::optional<Enclosure> enclosure_of(const Content& content, const Camera& camera);

/// What lights are placed and metered by.
struct Stage {
    const Content& content;
    const Camera& camera;
    std::optional<Enclosure> enclosure = {};
};

/// Key, fill and rim as far as they are on: automatic ones are off but for the key, by `key_by_default`. In
/// closed content the key is a lamp beside the camera.
std::vector<ResolvedLight> resolve_studio_lights(const Stage& stage, bool key_by_default,
                                                 LightsSettings& settings, const Vec3d& up);

/// Exposure by incident light at the content's centre, whatever the content looks like (as a hand-held meter
/// does); in closed content at what the camera sees, without the environment, with what walls send back.
float metered_exposure(const Stage& stage, const ResolvedSettings& resolved, float environment_intensity);

}  // namespace easypbr::detail
