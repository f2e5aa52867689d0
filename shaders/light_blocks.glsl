// What the uniform blocks of lights and of shadow maps hold for each. C++ includes this file too, in
// render/frame/shading_inputs.h: all members are of the type vec4, which std140 and C++ lay out alike.

struct Light {
    vec4 position;   // relative to the camera; w: 0 directional, 1 point, 2 spot, 3 rectangle, 4 disc, 5 sphere
    vec4 color;      // intensity times colour; w: 1 / range^2, or 0
    vec4 direction;  // unit, where the light goes; w: area of an area light, of others the radius of the disc that they are
                     // seen as, of parallel light at a distance of 1
    vec4 cone;       // spot: scale and offset of the cosine. Rectangle: half the width as a vector, half the height. Disc
                     // and sphere: the radius as a vector, the radius
};

struct ShadowMap {
    vec4 x, y, z;  // rows: from a position relative to the camera to the light's frame
    vec4 window;   // map coordinates = window.xy * (x, y) / w + window.zw
    vec4 depth;    // depth = (depth.x * z + depth.y) / w; z: 1 where w = z, 0 where w = 1; w: first layer
    vec4 size;     // x: the light's radius as a slope per unit of depth; y: depth per slope of a plane;
                   // z: size of a texel per w; w: no caster's depth is larger
};
