// Eye-dome lighting of points that light passes: by the nearest of them, or of the opaque surfaces, at each pixel. All layers
// of a pixel are shaded alike: they are seen through the nearest.
uniform sampler2D u_nearest;
uniform sampler2D u_opaque;
uniform vec2 u_size;

float depth_at(vec2 uv) { return max(textureLod(u_nearest, uv, 0.0).r, textureLod(u_opaque, uv, 0.0).r); }
#include "common_eye_dome.glsl"

layout(location = 0) out float o_shade;

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    o_shade = eye_dome(uv, depth_at(uv));
}
