// libigl takes a mesh's matrices as they are: curvature of a ring as a scalar. Writes curvature.png. Built
// where CMake finds libigl (2.5 or newer).
#include <easypbr/easypbr.h>
#include <igl/gaussian_curvature.h>

#include <cmath>
#include <cstdio>

int main() {
    using namespace easypbr;
    try {
        // The texture's seam has its vertices twice; welded, the ring is closed for libigl too.
        Mesh ring = remove_duplicate_vertices(make_torus(1, 0.4f, 192, 96), {0, false});
        Eigen::VectorXd angle;
        igl::gaussian_curvature(ring.V(), ring.F(), angle);
        // Gauss and Bonnet: 0 in sum over any ring.
        if (std::abs(angle.sum()) > 0.01) return 1;
        ring.add_scalar("curvature", Array1f(angle));

        Scene scene;
        scene.show(ring, "ring");
        Viewer view(scene);
        view.recorder.record("curvature.png");
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
