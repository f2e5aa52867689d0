// One triangle that covers the screen at the depth of infinity: with the depth test "less" it is drawn where there is
// geometry (reversed Z), with "equal" where there is none.
void main() {
    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
    gl_Position = vec4(corner * 4.0 - 1.0, 0.0, 1.0);
}
