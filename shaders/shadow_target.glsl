// What a caster leaves in a shadow map: its depth, larger towards the light; or what it takes from the light where it lets
// some through: sums, and largest alphas, which do not depend on the order of drawing. See common_shadow_tint.glsl for how
// they are read.
#feature TINT is_tinting

layout(location = 0) out vec4 o_absorption;  // rgb: -ln(transmittance); a: depth. Or r: depth
layout(location = 1) out vec4 o_moment;      // rgb: -ln(transmittance) times depth; a: minus depth

void write_depth() { o_absorption = vec4(gl_FragCoord.z, 0.0, 0.0, 0.0); }

// e^-16 is nothing.
vec3 absorption_of(vec3 through) { return -log(clamp(through, 1.125e-7, 1.0)); }

void write_tint(vec3 through) {
    vec3 absorption = absorption_of(through);
    if (absorption == vec3(0.0)) discard;
    o_absorption = vec4(absorption, gl_FragCoord.z);
    o_moment = vec4(absorption * gl_FragCoord.z, -gl_FragCoord.z);
}
