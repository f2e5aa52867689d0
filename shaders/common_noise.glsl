uniform vec2 u_noise_origin;  // the targets' first pixel in the picture: tiles continue one pattern

// Interleaved gradient noise (Jimenez 2014), shifted by the golden ratio from one accumulated frame to the next, so that
// the frames' values at a pixel are spread evenly over [0, 1).
float frame_noise(vec2 pixel, float frame) {
    float noise = fract(52.9829189 * fract(dot(pixel + u_noise_origin, vec2(0.06711056, 0.00583715))));
    return fract(noise + frame * 0.6180339887);
}
