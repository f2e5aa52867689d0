// Settings: one plain struct per effect. Defaults stand here; unit, range and documentation in fields.cpp.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/scene/auto.h"
#include "easypbr/scene/camera.h"
#include "easypbr/scene/light.h"
#include "easypbr/scene/material.h"
#include "easypbr/scene/style.h"

namespace easypbr {

enum class Antialias { none, fxaa };
enum class BackgroundMode { color, environment, blur, image, transparent };
enum class Brdf { height_correlated, separable, ue4 };
enum class ShadowMode { hard, pcf, soft };
enum class GroundMode { none, shadow, plane };
enum class TransparencyMode { layers, stochastic };
enum class Corner { top_left, top_right, bottom_left, bottom_right };
enum class OcclusionMethod { horizon, hemisphere };
enum class OcclusionResolution { adaptive, half, full };
enum class ToneOperator { aces, reinhard, agx, neutral, none };

struct ImageSettings {
    Vec2i size{800, 600};
    int samples = 16;
    Antialias antialias = Antialias::fxaa;
};

struct CameraSettings {
    Projection projection = Projection::perspective;
    Auto<Vec3d> position;
    Auto<Vec3d> target;
    std::string up = "+y";
    float fov_y_deg = 30;
    Auto<double> ortho_height;
    Auto<double> near;
    float azimuth_deg = 30;
    float elevation_deg = 15;
    float margin = 0.05f;
    std::vector<double> pose;        ///< empty, or 16 numbers: T_world_cam row by row, OpenGL axes
    std::vector<double> intrinsics;  ///< empty, or fx, fy, cx, cy, width, height and skew (OpenCV)
    DistortionModel distortion_model = DistortionModel::brown_conrady;
    std::vector<double> distortion;  ///< empty, or coefficients in OpenCV's order
};

struct EnvironmentSettings {
    std::string file;
    Auto<bool> enabled;
    float rotation_deg = 0;
    float intensity = 1;
    Auto<bool> sun;
};

struct BackgroundSettings {
    BackgroundMode mode = BackgroundMode::color;
    Vec3 color{0.25f, 0.25f, 0.25f};
    std::string image;
    float blur = 0.4f;
};

/// A light of this colour, sRGB from 0 to 255.
StudioLight studio_light(int red, int green, int blue);

struct LightsSettings {
    StudioLight key = studio_light(255, 241, 224);   ///< a little warm
    StudioLight fill = studio_light(230, 239, 255);  ///< a little cool
    StudioLight rim = studio_light(255, 255, 255);
    float intensity = 1;
};

struct ShadowSettings {
    bool enabled = true;
    ShadowMode mode = ShadowMode::soft;
    int resolution = 1024;
};

/// A plane that the content stands on.
struct GroundSettings {
    GroundMode mode = GroundMode::none;
    Auto<double> height;
    float strength = 1;
    Vec3 color{0.5f, 0.5f, 0.5f};
    float roughness = 0.7f;
    Auto<float> radius;
};

struct ShadingSettings {
    Brdf brdf = Brdf::height_correlated;
    bool multiple_scattering = true;
    float dielectric_f0 = 0.04f;
};

/// Of points without normals (Boucheny 2009).
struct EdlSettings {
    bool enabled = true;
    float strength = 0.4f;
    float radius = 1.4f;
};

struct TransparencySettings {
    TransparencyMode mode = TransparencyMode::layers;
    int max_layers = 64;
};

/// Screen-space ambient occlusion.
struct SsaoSettings {
    Auto<bool> enabled;
    OcclusionMethod method = OcclusionMethod::horizon;
    OcclusionResolution resolution = OcclusionResolution::adaptive;
    Auto<float> radius;
    float falloff = 0.6f;
    float power = 1;
    int directions = 1;
    int steps = 6;
    bool multi_bounce = true;
};

/// Light of the sky past what stands in its way, and reflections of the scene, by rays on the CPU.
struct RaySettings {
    Auto<bool> enabled;
    int count = 256;
};

/// Light that spreads in lens and eye.
struct BloomSettings {
    bool enabled = false;
    float intensity = 0.2f;
    float threshold = 1;
    float knee = 0.5f;
    Auto<int> levels;
    Auto<bool> suppress_fireflies;
};

/// A thin lens in the place of a pinhole.
struct DepthOfFieldSettings {
    bool enabled = false;
    float f_number = 2.8f;
    Auto<double> focus_distance;
    Auto<double> sensor_height;
};

/// Of stills, by their samples.
struct MotionBlurSettings {
    bool enabled = false;
    float shutter = 0.5f;
};

struct TonemapSettings {
    ToneOperator tone_operator = ToneOperator::aces;
    Auto<float> exposure;
    float exposure_compensation = 0;
};

/// Overrides of every material from outside; automatic: the material's own value.
struct MaterialSettings {
    Auto<Vec3> color;
    Auto<float> metallic;
    Auto<float> roughness;
    Auto<Vec3> emissive;
    Auto<AlphaMode> alpha_mode;
    Auto<float> opacity;
    Auto<float> clearcoat, clearcoat_roughness;
    Auto<Vec3> sheen_color;
    Auto<float> sheen_roughness;
    Auto<float> ior, specular;
    Auto<Vec3> specular_color;
    Auto<float> transmission, thickness;
    Auto<Vec3> attenuation_color;
    Auto<float> attenuation_distance;
    Auto<float> iridescence, iridescence_ior, iridescence_thickness;
    Auto<float> anisotropy, anisotropy_rotation_deg;
    std::string base_color_texture, metallic_texture, roughness_texture, normal_texture, occlusion_texture,
        emissive_texture, opacity_texture;
    std::string shader;
};

/// What is cut away of every object, in world space.
struct ClipSettings {
    std::vector<double> planes;  ///< four numbers each: what lies at n . p + d >= 0 is kept
    std::vector<double> box;     ///< empty, or the least and the largest x, y, z that are kept
};

struct PointsSettings {
    int hole_filling = 0;
};

/// What is written into the picture. Never into layers.
struct AnnotationSettings {
    Auto<bool> legend;
    Auto<bool> colorbar;
    std::string title;
    Corner corner = Corner::top_right;
    float text_size = 0.03f;
};

struct LoadSettings {
    float crease_deg = 30;
};

struct Settings {
    ImageSettings image;
    CameraSettings camera;
    EnvironmentSettings environment;
    BackgroundSettings background;
    LightsSettings lights;
    ShadowSettings shadows;
    GroundSettings ground;
    ShadingSettings shading;
    EdlSettings edl;
    TransparencySettings transparency;
    SsaoSettings ssao;
    RaySettings rays;
    BloomSettings bloom;
    DepthOfFieldSettings depth_of_field;
    MotionBlurSettings motion_blur;
    TonemapSettings tonemap;
    MaterialSettings material;
    Style style;  ///< overrides of every object's style; automatic: the object's own value
    PointsSettings points;
    ClipSettings clip;
    AnnotationSettings annotation;
    LoadSettings load;
};

}  // namespace easypbr
