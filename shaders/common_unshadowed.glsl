// In place of common_shadow.glsl where no light has a shadow map.
vec3 shadow_single(int index, vec3 position, vec3 normal, bool needed) { return vec3(1.0); }
vec3 shadow_cube(int index, vec3 position, vec3 normal, bool needed) { return vec3(1.0); }
float brightness(vec3 part) { return part.r; }
