// Stochastic transparency (Enderton et al. 2010): a surface is drawn where its opacity is above a random number, a new
// one for every pixel, frame and depth, so that surfaces behind each other are left out independently.
uniform float u_sample_index;
uniform vec2 u_noise_origin;  // the targets' first pixel in the picture

// PCG hash (Jarzynski and Olano 2020).
uint stochastic_hash(uint v) {
    uint state = v * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

float alpha_threshold() {
    uvec2 pixel = uvec2(gl_FragCoord.xy + u_noise_origin);
    uint h = stochastic_hash(pixel.x + stochastic_hash(pixel.y + stochastic_hash(uint(u_sample_index))));
    return float(stochastic_hash(h + floatBitsToUint(gl_FragCoord.z)) >> 8u) / 16777216.0;
}
