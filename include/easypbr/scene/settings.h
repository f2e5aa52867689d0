// Settings: one plain struct per group, with defaults, meanings, units and ranges. The table of fields
// (scene/fields.h) gives each a name and a description, and checks its range.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/scene/auto.h"
#include "easypbr/scene/camera.h"
#include "easypbr/scene/effects/effects.h"
#include "easypbr/scene/light.h"
#include "easypbr/scene/material.h"
#include "easypbr/scene/style.h"

namespace easypbr {

/// The name of a file as it was given, and the file that it meant then: a relative name is that of a file in
/// the folder that was the working folder when the name was assigned. Assign and read it like a string;
/// copies mean the same file.
class NamedFile {
  public:
    NamedFile() = default;
    NamedFile(std::string name);
    NamedFile(const char* name) : NamedFile(std::string(name)) {}

    /// As it was given; empty: no file.
    const std::string& name() const { return name_; }
    operator const std::string&() const { return name_; }
    bool empty() const { return name_.empty(); }
    void clear() { *this = NamedFile(); }

    /// The absolute path; empty where no file is named.
    const std::string& path() const { return path_; }
    /// A path to open it by, which messages may hold: the name, unless the working folder is another one than
    /// that it was given in; then the absolute path.
    const std::string& path_from_here() const;

    /// Whether the names and what they mean are the same.
    bool operator==(const NamedFile&) const = default;
    /// Compares the name.
    bool operator==(const std::string& name) const { return name_ == name; }
    bool operator==(const char* name) const { return name_ == name; }

  private:
    std::string name_, path_;
};

enum class Antialias { none, fxaa };
enum class BackgroundMode { color, environment, blur, image, transparent };
enum class Brdf { height_correlated, separable, ue4 };
enum class ShadowMode { hard, pcf, soft };
enum class TransparencyMode { layers, stochastic };
enum class SplatDepth { median, expected };
enum class Corner { top_left, top_right, bottom_left, bottom_right };
enum class ToneOperator { aces, reinhard, agx, neutral, none };

/// Size and sampling of the image.
struct ImageSettings {
    Vec2i size{800, 600};  ///< width and height in pixels, 1 to 65536
    int samples = 8;       ///< jittered samples averaged per pixel, 1 to 65536
    float noise =
        0;  ///< path traced images end once their noise is below, 0 to 1 (white); 0: by samples alone
    float time_budget = 0;  ///< seconds after which an image takes no further sample; 0: unlimited
    Antialias antialias = Antialias::fxaa;  ///< of a single frame; accumulation anti-aliases by its samples
};

/// Pose, projection and lens of the camera. Automatic values frame the content.
template <template <class> class MaybeAuto>
struct BasicCameraSettings {
    Projection projection = Projection::perspective;
    MaybeAuto<Vec3d> position{};       ///< world units; automatic: frames the content
    MaybeAuto<Vec3d> target{};         ///< point looked at, world units; automatic: centres the content
    MaybeAuto<std::string> up{};       ///< world axis that points up: +x, -x, +y, -y, +z or -z; any case
    float fov_y_deg = 30;              ///< vertical field of view in degrees, 1 to 170; perspective
    MaybeAuto<double> ortho_height{};  ///< height of the view volume, world units, above 0; orthographic
    MaybeAuto<double> near{};          ///< distance to the near clipping plane, world units, above 0
    /// Of an automatic camera, degrees: 0 in front, positive to the right; automatic: 30, or where the camera of
    /// a depth image stood.
    MaybeAuto<float> azimuth_deg{};
    /// Of an automatic camera, degrees: 0 level, 90 from above; automatic: 15, or where the camera of a depth
    /// image stood.
    MaybeAuto<float> elevation_deg{};
    float margin = 0.05f;              ///< fraction of the image left free by an automatic camera, 0 to 0.9
    std::vector<double> pose;          ///< empty, or 16 numbers: T_world_cam row by row, OpenGL axes
    std::vector<double> intrinsics;    ///< empty, or fx, fy, cx, cy, width, height and skew (OpenCV), pixels
    DistortionModel distortion_model = DistortionModel::brown_conrady;  ///< meaning of `distortion` (OpenCV)
    std::vector<double> distortion;  ///< empty, or 4, 5 or 8 coefficients in OpenCV's order
};
using CameraSettings = BasicCameraSettings<Auto>;

/// Image-based lighting by an equirectangular environment map.
template <template <class> class MaybeAuto>
struct BasicEnvironmentSettings {
    NamedFile file;                ///< HDR, EXR, PNG or JPEG; empty: a built-in studio
    MaybeAuto<bool> enabled{};     ///< enables image-based lighting; automatic: on
    float rotation_deg = 0;        ///< about the up axis, degrees, counter-clockwise seen from above
    MaybeAuto<float> intensity{};  ///< scale factor of the radiance, 0 to 1e6; automatic: 0.2 of the studio
    MaybeAuto<bool> sun{};  ///< sun as a directional light with shadows; automatic: if a given map has one
};
using EnvironmentSettings = BasicEnvironmentSettings<Auto>;

/// A colour of 8 bits per channel.
inline Vec3 rgb8(int red, int green, int blue) {
    return Vec3(float(red), float(green), float(blue)) / 255.0f;
}

/// What is visible where there is no content.
struct BackgroundSettings {
    BackgroundMode mode = BackgroundMode::color;  ///< transparent: alpha 0
    Vec3 color = rgb8(217, 217, 217);             ///< sRGB-encoded; neither exposed nor tone mapped
    NamedFile image;                              ///< for mode image
    float blur = 0.4f;                            ///< of the environment map in mode blur: 0 none, 1 the most

    /// Whether the environment is visible behind the content.
    bool shows_environment() const {
        return mode == BackgroundMode::environment || mode == BackgroundMode::blur;
    }
};

/// Three-point lighting, placed relative to the camera.
template <template <class> class MaybeAuto>
struct BasicLightsSettings {
    BasicStudioLight<MaybeAuto> key{.color = rgb8(255, 241, 224)};   ///< main light, slightly warm
    BasicStudioLight<MaybeAuto> fill{.color = rgb8(230, 239, 255)};  ///< opposite the key, weaker, cool
    BasicStudioLight<MaybeAuto> rim{.color = rgb8(255, 255, 255)};   ///< from behind
    float intensity = 1;                                             ///< scale factor of all three, 0 to 1e6
};
using LightsSettings = BasicLightsSettings<Auto>;

/// Shadow maps of all lights that cast shadows.
struct ShadowSettings {
    bool enabled = true;
    ShadowMode mode = ShadowMode::soft;  ///< soft: PCSS; pcf: 3x3 texels; hard: unfiltered
    int resolution = 1024;               ///< width and height of a shadow map in texels, 16 to 8192
};

/// The specular BRDF of all materials.
struct ShadingSettings {
    Brdf brdf = Brdf::height_correlated;  ///< masking-shadowing function of GGX
    bool multiple_scattering = true;      ///< energy compensation
    /// Reflectance at normal incidence where ior is 1.5, 0 to 1.
    float dielectric_f0 = Material::default_f0;
};

/// Eye-dome lighting of points without normals (Boucheny 2009).
struct EdlSettings {
    bool enabled = true;
    float strength = 0.4f;  ///< 0 to 100
    float radius = 1.4f;    ///< sampling radius in pixels of an image 1080 pixels high, 0.1 to 100
};

/// Drawing order of transparent surfaces.
struct TransparencySettings {
    TransparencyMode mode = TransparencyMode::layers;  ///< layers: depth peeling
    int max_layers = 64;                               ///< peeled per pixel, 1 to 10000
};

/// Exposure and tone mapping.
template <template <class> class MaybeAuto>
struct BasicTonemapSettings {
    /// Setting tonemap.operator. ACES (Hill's fit), Reinhard on luminance, AgX, Khronos PBR Neutral, or none:
    /// clamped.
    ToneOperator tone_operator = ToneOperator::aces;
    MaybeAuto<float> exposure{};      ///< linear scale factor; automatic: metered by incident light
    float exposure_compensation = 0;  ///< EV, -30 to 30
};
using TonemapSettings = BasicTonemapSettings<Auto>;

/// Overrides of every material from outside; automatic: the material's own value. Colours are sRGB-encoded;
/// units and ranges are those of Material.
struct MaterialSettings {
    Override<Vec3> color;                 ///< base colour
    Override<float> metallic;             ///< 0 dielectric to 1 metal
    Override<float> roughness;            ///< perceptual, 0 to 1
    Override<Vec3> emissive;              ///< emitted radiance
    Override<AlphaMode> alpha_mode;       ///< opaque, mask or blend
    Override<float> opacity;              ///< 0 transparent to 1 opaque
    Override<float> clearcoat;            ///< strength, 0 to 1
    Override<float> clearcoat_roughness;  ///< 0 to 1
    Override<Vec3> sheen_color;
    Override<float> sheen_roughness;          ///< 0 to 1
    Override<float> ior;                      ///< index of refraction, 1 to 100
    Override<float> specular;                 ///< strength of the specular reflection of dielectrics, 0 to 1
    Override<Vec3> specular_color;            ///< of dielectrics, at normal incidence
    Override<float> transmission;             ///< fraction of light transmitted by dielectrics, 0 to 1
    Override<float> thickness;                ///< of the volume, mesh units; 0: thin-walled
    Override<Vec3> attenuation_color;         ///< of white light after attenuation_distance
    Override<float> attenuation_distance;     ///< world units, above 0
    Override<float> dispersion;               ///< of the volume, 20 / Abbe number, 0 to 40
    Override<float> iridescence;              ///< strength, 0 to 1
    Override<float> iridescence_ior;          ///< index of refraction of the thin film, 1 to 100
    Override<float> iridescence_thickness;    ///< of the thin film, nanometres
    Override<float> anisotropy;               ///< strength, 0 to 1
    Override<float> anisotropy_rotation_deg;  ///< degrees, counter-clockwise from the tangent
    /// Files; empty: the material's own.
    NamedFile base_color_texture, metallic_texture, roughness_texture, normal_texture, occlusion_texture,
        emissive_texture, opacity_texture;
    NamedFile shader;  ///< file of a GLSL surface shader; empty: the material's own
};

/// Clipping of every object, in world space.
struct ClipSettings {
    std::vector<double> planes;  ///< four numbers n, d each, up to 16 planes; n . p + d >= 0 is kept
    std::vector<double> box;     ///< empty, or minimum and maximum x, y, z; the inside is kept
};

/// Point clouds.
struct PointsSettings {
    int hole_filling = 0;  ///< passes that fill one-pixel holes between points, 0 to 32
};

/// 3D Gaussian splats among lights and other objects.
struct SplatSettings {
    bool cast = true;     ///< they cast shadows with their opacity, and rays see them
    bool receive = true;  ///< surfaces darken them where they hide lights and sky
    bool resort = false;  ///< the splats of each pixel are in the order of their depths there
    bool soft = true;  ///< surfaces hide the part of a splat that is behind them, else all or nothing of it
    bool relight =
        false;  ///< lamps and sky light them: degree 0 is their albedo, the thinnest axis the normal
    SplatDepth depth = SplatDepth::median;  ///< of layers; expected: the mean by what each splat adds
};

/// Legends and colour bars drawn into the image, never into layers.
template <template <class> class MaybeAuto>
struct BasicAnnotationSettings {
    MaybeAuto<bool> legend{};    ///< of the labels that colour objects; automatic: no
    MaybeAuto<bool> colorbar{};  ///< of the values that colour objects; automatic: no
    std::string title;           ///< empty: the name of the values
    Corner corner = Corner::top_right;
    /// Fraction of the image's shorter side, 0.005 to 0.2; at least 11 pixels where that fits, up to a third
    /// smaller where only that fits beside the content.
    float text_size = 0.03f;
    bool operator==(const BasicAnnotationSettings&) const = default;
};
using AnnotationSettings = BasicAnnotationSettings<Auto>;

/// Loading of files by the command line and the window, and normals of what has none.
template <template <class> class MaybeAuto>
struct BasicLoadSettings {
    /// Edges between faces at a larger angle are sharp, degrees, 0 to 180; automatic: 30 for STL files, 60
    /// for all else. A mesh whose V changes while its F stays keeps the edges that were sharp at first.
    MaybeAuto<float> crease_deg{};
    std::string variant;  ///< glTF: name of the material variant; empty: the file's own materials
};
using LoadSettings = BasicLoadSettings<Auto>;

/// Limits on what files may ask for.
struct LimitSettings {
    float memory =
        0;  ///< most that reading a file takes, GB, 0 to 1e6; 0: three quarters of what is available
};

/// All settings. Paths of members are the names of settings, as in bloom.intensity.
template <template <class> class MaybeAuto>
struct BasicSettings {
    ImageSettings image;
    BasicCameraSettings<MaybeAuto> camera;
    BasicEnvironmentSettings<MaybeAuto> environment;
    BackgroundSettings background;
    BasicLightsSettings<MaybeAuto> lights;
    ShadowSettings shadows;
    ShadingSettings shading;
    EdlSettings edl;
    TransparencySettings transparency;
#define EASYPBR_MEMBER(name, Type) Type name;
    EASYPBR_EFFECTS(EASYPBR_MEMBER)
#undef EASYPBR_MEMBER
    BasicTonemapSettings<MaybeAuto> tonemap;
    MaterialSettings material;
    Style style;  ///< overrides of the style of every object; automatic: the object's own value
    PointsSettings points;
    SplatSettings splats;
    ClipSettings clip;
    BasicAnnotationSettings<MaybeAuto> annotation;
    BasicLoadSettings<MaybeAuto> load;
    LimitSettings limits;
};

/// What users set.
struct Settings : BasicSettings<Auto> {};

/// What an image is drawn with: every automatic value is inferred.
struct InferredSettings : BasicSettings<Inferred> {};

}  // namespace easypbr
