// Gaussian splats on the screen, as the CPU has them (native::ScreenSplat).
struct ScreenSplat {
    vec4 place;   // column, row, half the width and height of what is seen of it: pixels
    vec4 shape;   // inverse covariance: xx, xy, yy; opacity
    vec4 color;   // sRGB-encoded; reversed depth of the mean
    vec4 depths;  // change of depth by column and row; one over its standard deviation; perspective: the mean's depth
};
layout(std430, binding = 0) buffer Splats { ScreenSplat splats[]; };
layout(std430, binding = 1) buffer Order { uint order[]; };  // places of splats, from the farthest on

const float least_alpha = 1.0 / 255.0;
const float most_alpha = 0.99;
