// The equirectangular convention of scene/environment.h: +Y up, u = 0.5 is -Z, v = 0 is the top.
uniform mat3 u_env_from_world;

vec2 equirect_uv(vec3 direction) {
    const float inverse_pi = 0.31830988618379067;
    return vec2(atan(direction.x, -direction.z) * (0.5 * inverse_pi) + 0.5,
                atan(length(direction.xz), direction.y) * inverse_pi);
}

// Mip level of the prefiltered environment for a roughness; the inverse stands in gpu/prefilter.cpp.
float prefiltered_level(float roughness, float last_level) { return roughness * (2.0 - roughness) * last_level; }
