// The environment where there is no geometry: sharp from the equirectangular picture, or blurred from the prefiltered one.
#include "common_camera.glsl"
#include "common_environment.glsl"

#feature BLUR is_blurred

uniform float u_env_intensity;
uniform float u_level;
uniform samplerCube u_prefiltered;
uniform sampler2D u_equirect;

layout(location = 0) out vec4 o_radiance;

void main() {
    vec3 direction = u_env_from_world * ray_of_any_length(gl_FragCoord.xy);
    vec3 radiance = is_blurred ? textureLod(u_prefiltered, direction, u_level).rgb
                               : textureLod(u_equirect, equirect_uv(direction), u_level).rgb;
    o_radiance = vec4(radiance * u_env_intensity, 1.0);
}
