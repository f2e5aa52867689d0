// What surfaces mirror of the ground that they stand above: inputs of shaders/lighting_ground.glsl.
#pragma once

#include "easypbr/render/frame/screen_shader.h"

namespace easypbr::render {

/// A plane whose light counts, or a background of one colour before which a catcher shows its shadows.
struct MirroredGround {
    Vec4 plane;       ///< its up axis; its height above the camera
    Vec3 color;       ///< base colour of the plane; radiance of the background
    Vec3 sky;         ///< light of the environment on it, divided by pi
    Vec3 hidden;      ///< mean radiance of the environment below
    bool lit;         ///< a plane, not a catcher
    float strength;   ///< of the catcher's shadow
    float roughness;  ///< of the plane
    Vec4 middle;  ///< of the plane, under the content, relative to the camera; w: radius at which nothing is
                  ///< left

    void set(ShaderInputs& values) const {
        values.define("GROUND");
        values.set("u_ground", plane);
        values.set("u_ground_color", color);
        values.set("u_ground_sky", sky);
        values.set("u_ground_hidden", hidden);
        values.set("u_ground_strength", strength);
        if (!lit) return;
        values.define("GROUND_PLANE");
        values.set("u_ground_roughness", roughness);
        values.set("u_ground_middle", middle);
    }
};

}  // namespace easypbr::render
