// A material's own shader: what a surface is made of can be read and changed before it goes into the G-buffer.
uniform vec3 u_eye;  // world
in vec3 v_own_position;

// All vectors are the world's, in the scene's frame, but own_position; colours are linear.
struct Surface {
    vec3 position;      // read only, as are the next four
    vec3 own_position;  // in the mesh's own coordinates
    vec3 face_normal;   // without the normal texture, towards the viewer's side
    vec3 view;          // unit vector to the camera
    vec2 uv;            // of the mesh, v upwards; 0 where it has none
    vec3 base_color;    // 0 to 1
    float opacity;      // counts where the material's alpha mode is mask or blend
    float metallic, roughness, occlusion;  // 0 to 1
    vec3 normal;        // that light is reflected by; need not be of unit length
    vec3 emission;      // radiance that is added
    bool unlit;         // the base colour is the radiance: no light counts
};

#include "geometry_shader_own.glsl"

void shade_own(inout vec4 color, inout Normals n, inout float metallic, inout float roughness, inout float occlusion,
               inout vec3 emission, inout float kind) {
    Surface s;
    s.position = u_eye + v_position;
    s.own_position = v_own_position;
    s.face_normal = n.geometric;
    s.view = u_backwards.w > 0.5 ? u_backwards.xyz : normalize(-v_position);
    s.uv = has_uv ? v_uv : vec2(0.0);
    s.base_color = color.rgb;
    s.opacity = color.a;
    s.metallic = metallic;
    s.roughness = roughness;
    s.occlusion = occlusion;
    s.normal = n.shading;
    s.unlit = kind > 0.9;
    s.emission = s.unlit ? vec3(0.0) : emission;
    surface(s);
    color = vec4(s.base_color, s.opacity);
    metallic = s.metallic;
    roughness = s.roughness;
    occlusion = s.occlusion;
    if (dot(s.normal, s.normal) > 1e-12) n.shading = normalize(s.normal);
    if (s.unlit)
        kind = 1.0;
    else if (kind > 0.9)
        kind = 0.0;
    emission = s.unlit ? s.base_color : s.emission;
    // What is no number would spread over the picture.
    if (any(isnan(emission)) || any(isinf(emission))) emission = vec3(0.0);
}
