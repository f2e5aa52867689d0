// Arrays that the library has made are freed here, and the other way round. Prints the depth of a box of edge
// 1 whose front face is 4.5 before the camera.
#include <easypbr/easypbr.h>

#include <Eigen/Dense>
#include <cstdio>

int main() {
    using namespace easypbr;
    Mesh box = make_box();
    for (int i = 0; i < 20; ++i) {
        const Array3i F = make_box().F();  // the library's; this is its last handle
        box.set_F(Array3i::Dense(F.topRows(i % 12 + 1)));
        box.set_V(Array3f::Dense(box.V() * (i % 2 ? 2.0f : 0.5f)));
        const Mesh ball = make_icosphere(1, i % 4);
        box.set_F(Array3i(make_box().F()));
    }
    const KdTree tree(box.V());
    if (tree.nearest(box.V(), 3).indices.cols() != 3) return 1;
    // Eigen's own functions keep the alignment that they count on. 600: blocks of products then come from the
    // heap.
    const Eigen::MatrixXd A = Eigen::MatrixXd::Identity(600, 600);
    if ((A * A).eval() != A || !A.topLeftCorner(50, 50).colPivHouseholderQr().isInvertible()) return 2;
    Scene scene;
    scene.show(box, "box");
    Viewer view(scene, DrawDevice::cpu);
    view.set_camera(Camera::look_at({0, 0, 5}, {0, 0, 0}));
    const auto layers = view.render_layers({"depth"}, Vec2i(9, 9));
    std::printf("%g\n", layers.at("depth").at<float>(4, 4)[0]);
}
