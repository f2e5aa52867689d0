// The environment where there is no geometry: sharp from the equirectangular picture, or blurred from the prefiltered one.
#include "common_camera.glsl"
#include "common_environment.glsl"

uniform float u_env_intensity;
uniform float u_level;
#ifdef BLUR
uniform samplerCube u_prefiltered;
#else
uniform sampler2D u_equirect;
#endif

layout(location = 0) out vec4 o_radiance;

void main() {
    vec3 direction = u_env_from_world * ray_direction(gl_FragCoord.xy);
#ifdef BLUR
    vec3 radiance = textureLod(u_prefiltered, direction, u_level).rgb;
#else
    vec3 radiance = textureLod(u_equirect, equirect_uv(direction), u_level).rgb;
#endif
    o_radiance = vec4(radiance * u_env_intensity, 1.0);
}
