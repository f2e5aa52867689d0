"""Mesh files for tests."""
import math


def write_sphere(path, segments=96):
    """UV sphere of radius 1 with exact normals."""
    rings = segments // 2
    lines = []
    for i in range(rings + 1):
        theta = math.pi * i / rings
        for j in range(segments):
            phi = 2 * math.pi * j / segments
            p = (math.sin(theta) * math.cos(phi), math.cos(theta), math.sin(theta) * math.sin(phi))
            lines.append("v %.9g %.9g %.9g" % p)
            lines.append("vn %.9g %.9g %.9g" % p)
    for i in range(rings):
        for j in range(segments):
            k = (j + 1) % segments
            a, b, c, d = (1 + r * segments + s for r, s in ((i, j), (i, k), (i + 1, k), (i + 1, j)))
            lines.append(f"f {a}//{a} {b}//{b} {c}//{c} {d}//{d}")
    path.write_text("\n".join(lines) + "\n")
    return path


def write_box(path):
    """Cube with corners at -1 and 1 and uv on every face."""
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    lines = ["v %d %d %d" % c for c in corners] + ["vt 0 0", "vt 1 0", "vt 1 1", "vt 0 1"]
    for quad in ((1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)):
        lines.append("f " + " ".join(f"{v}/{t}" for t, v in enumerate(quad, 1)))
    path.write_text("\n".join(lines) + "\n")
    return path
