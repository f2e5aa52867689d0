"""A mesh's own shading by a few lines of GLSL: contour lines of height on a teapot, and a rim that glows.
Writes own_shading.png."""

from easypbr import Scene, Viewer, shapes

CONTOURS = """
void surface(inout Surface s) {
    float height = s.own_position.y * 12.0;
    // As wide on the screen wherever the surface leans.
    float line = abs(fract(height) - 0.5) / fwidth(height);
    s.base_color = mix(vec3(0.02, 0.05, 0.2), vec3(0.8, 0.75, 0.6), smoothstep(0.5, 1.5, line));
    s.roughness = 0.3;
    float rim = 1.0 - max(dot(s.normal, s.view), 0.0);
    s.emission = vec3(0.1, 0.4, 1.0) * pow(rim, 4.0);
}
"""

scene = Scene()
teapot = shapes.teapot()
teapot.material.shader = CONTOURS  # or pathlib.Path("contours.glsl"), read again whenever it changes
scene.show(teapot, "teapot")
view = Viewer((800, 600), scene=scene)
view.recorder.record("own_shading.png")
