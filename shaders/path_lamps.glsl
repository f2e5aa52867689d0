// Chooses one light of a block for each path, as likely as it is bright where it arrives (Talbot et al. 2005, resampled
// importance sampling, with all lights as candidates). Of an area light a point is chosen first; directions that are sampled
// by the BSDF find such lights too, and both are combined by MIS. Included after the surfaces.
#include "path_emitters.glsl"

#feature AREA_LIGHTS has_area_lights

uniform int u_light_count;

in float v_choice;  // in [0, 1)
in vec2 v_emitter;  // in [0, 1): the point of the light

out vec3 o_light;    // what arrives of the chosen one, unless it is hidden, as if it stood for all
out float o_sum;     // luminance of all lights, if none is hidden
out float o_chosen;  // its number
out vec3 o_way;      // to its point; of parallel light that of way_to_disc()

// What an area light sends to the view by way of its point.
vec3 from_area(Light light, Surface s, out vec3 way) {
    float density;
    if (light.position.w > 4.5)
        way = way_to_sphere(light, v_position, v_emitter, density);
    else
        way = way_to_plane(light, v_position, v_emitter, density);
    vec3 l = way * inversesqrt(max(dot(way, way), 1e-30));
    vec3 c = light.color.rgb * bsdf(l, s) / max(density + bsdf_density(l, s), 1e-30);
    return density > 0.0 ? c : vec3(0.0);
}

void main() {
    Surface s = path_surface();
    float sum = 0.0, u = v_choice, chosen = 0.0;
    vec3 light = vec3(0.0), chosen_way = vec3(0.0);  // of the chosen one; the light of luminance 1
    vec4 place = vec4(0.0), direction = vec4(0.0);
    for (int i = 0; i < u_light_count; ++i) {
        vec3 l, way = vec3(0.0), c;
        if (has_area_lights && u_lights[i].position.w > 2.5)
            c = from_area(u_lights[i], s, way);
        else {
            vec3 arrives = arriving(u_lights[i], v_position, l);
            c = arrives * reflected_unmirrored(l, s);
        }
        float weight = luminance(c);
        sum += weight;
        float part = weight / max(sum, 1e-30);
        bool taken = u < part;
        // What is left of the number is as good as a new one.
        u = min(taken ? u / max(part, 1e-30) : (u - part) / max(1.0 - part, 1e-30), 0.99999994);
        chosen = taken ? float(i) : chosen;
        light = taken ? c / max(weight, 1e-30) : light;
        if (has_area_lights) chosen_way = taken ? way : chosen_way;
        place = taken ? u_lights[i].position : place;
        direction = taken ? u_lights[i].direction : direction;
    }
    o_light = light * sum;
    o_sum = sum;
    o_chosen = chosen;
    vec3 to_disc = way_to_disc(place, direction, v_position, v_emitter);
    o_way = place.w > 2.5 ? chosen_way : to_disc;
}
