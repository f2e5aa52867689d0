// The order of lines in depth. common_camera.glsl comes first.
uniform float u_half_width;  // of the lines that are drawn, pixels

// Whether what is drawn lies behind a line at a reversed depth, 0: there is none. A line is as deep as half its width:
// what lies no further behind it is beside it.
bool lies_behind(float depth, float line) {
    float z = axial_distance(line), thickness = (u_half_width + 1.0) * 2.0 * u_unproject.y / u_size.y;
    if (!is_orthographic) thickness *= z;
    return line > 0.0 && axial_distance(depth) > z + thickness;
}
