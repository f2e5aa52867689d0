// What all but the ground leaves of a pixel: 1 where a shadow catcher is seen with nothing before it, 0 where an opaque surface
// is. The mean over frames tells a shadow from what covers a part of a pixel.
#include "common_caught.glsl"
#include "common_shown.glsl"
#include "common_surface_kind.glsl"

uniform sampler2D u_radiance;
uniform sampler2D u_material;
uniform sampler2D u_depth_target;

layout(location = 0) out vec4 o_share;

// Of a darker shadow nothing tells what lies before it.
const float least_lit = 0.01;

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    float left = 1.0 - shown(textureLod(u_radiance, uv, 0.0), uv).a;
    bool covered = textureLod(u_depth_target, uv, 0.0).r > 0.0;
    bool catches = is_ground_catcher(textureLod(u_material, uv, 0.0).w);
    float lit = 1.0 - missing_light(uv);
    lit = is_scene_linear ? lit : min(lit, 1.0);  // as displayed() has it
    float behind = lit > least_lit ? left / lit : 1.0;
    float open = catches ? behind : 0.0;
    o_share = vec4(clamp(covered ? open : left, 0.0, 1.0));
}
