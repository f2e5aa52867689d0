// Chooses one light of a block for each path, as likely as it is bright where it arrives (Talbot et al. 2005, resampled
// importance sampling, with all lights as candidates). Included after the surfaces.
uniform int u_light_count;

in float v_choice;  // in [0, 1)

out vec3 o_light;    // what arrives of the chosen one, unless it is hidden, as if it stood for all
out float o_sum;     // luminance of all lights, if none is hidden
out float o_chosen;  // its number

void main() {
    Surface s = path_surface();
    float sum = 0.0, u = v_choice, chosen = 0.0;
    vec3 light = vec3(0.0);  // of the chosen one, of luminance 1
    for (int i = 0; i < u_light_count; ++i) {
        vec3 l;
        vec3 arrives = arriving(u_lights[i], v_position, l);
        vec3 c = arrives * reflected(l, s);
        float weight = luminance(c);
        sum += weight;
        float part = weight / max(sum, 1e-30);
        bool taken = u < part;
        // What is left of the number is as good as a new one.
        u = min(taken ? u / max(part, 1e-30) : (u - part) / max(1.0 - part, 1e-30), 0.99999994);
        chosen = taken ? float(i) : chosen;
        light = taken ? c / max(weight, 1e-30) : light;
    }
    o_light = light * sum;
    o_sum = sum;
    o_chosen = chosen;
}
