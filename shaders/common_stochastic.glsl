// Stochastic transparency (Enderton et al. 2010): a surface is drawn where its opacity is above a random number, a new
// one for every pixel, frame and depth, so that surfaces behind each other are left out independently.
uniform float u_sample_index;

// PCG hash (Jarzynski and Olano 2020).
uint hash(uint v) {
    uint state = v * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

float alpha_threshold() {
    uint h = hash(uint(gl_FragCoord.x) + hash(uint(gl_FragCoord.y) + hash(uint(u_sample_index))));
    return float(hash(h + floatBitsToUint(gl_FragCoord.z)) >> 8u) / 16777216.0;
}
