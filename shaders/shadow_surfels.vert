// Surfels into a shadow map: quads around their ellipses, one instance each.
#feature VERTEX_COLOR has_vertex_colors

layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec4 a_color;
layout(location = 3) in vec4 a_axes;  // tangent, its length being the first semi-axis; length of the second

uniform mat4 u_clip_from_mesh;
uniform mat3 u_world_from_mesh;
uniform vec4 u_light;   // in the mesh's frame; w 0: direction towards it
uniform vec2 u_surfel;  // factor on the size, radius without a tangent
uniform float u_opacity;

flat out float v_alpha;
out vec2 v_place;  // in the ellipse, whose rim is at 1

vec3 any_perpendicular(vec3 n) {
    return normalize(abs(n.x) > abs(n.z) ? vec3(-n.y, n.x, 0.0) : vec3(0.0, -n.z, n.y));
}

void main() {
    // As in geometry_surfels.vert.
    vec3 to_light = normalize(u_light.xyz - u_light.w * a_position);
    vec3 n = dot(a_normal, a_normal) > 0.0 ? normalize(a_normal) : to_light;
    float radius = length(a_axes.xyz);
    vec3 direction = a_axes.xyz - n * dot(n, a_axes.xyz);
    direction = dot(direction, direction) > 1e-12 * radius * radius ? normalize(direction) : any_perpendicular(n);
    float first = u_surfel.y > 0.0 ? u_surfel.y : radius;
    float second = u_surfel.y > 0.0 ? u_surfel.y : a_axes.w;
    v_place = vec2((gl_VertexID & 1) == 0 ? -1.0 : 1.0, (gl_VertexID & 2) == 0 ? -1.0 : 1.0);
    vec3 t = direction * (first * u_surfel.x), b = cross(n, direction) * (second * u_surfel.x);
    // Behind the surface that bends within a surfel: it must not shadow its neighbours.
    float longer = max(length(u_world_from_mesh * t), length(u_world_from_mesh * b));
    vec3 p = a_position - to_light * (0.25 * longer / length(u_world_from_mesh * to_light));
    gl_Position = u_clip_from_mesh * vec4(p + v_place.x * t + v_place.y * b, 1.0);
    v_alpha = u_opacity;
    if (has_vertex_colors) v_alpha *= a_color.a;
}
