#include "easypbr/render/primitives/mesh/volume_side.h"

namespace easypbr::render {
namespace {

bool sees_backs_alone(const Frame& frame, const DrawItem& item) {
    const MeshData& mesh = item.mesh();
    const Eigen::Affine3d mesh_from_world = item.object->T_world_mesh.inverse();
    const Vec3d eye = mesh_from_world * frame.camera.position(),
                backwards = mesh_from_world.linear() * frame.camera.T_world_cam.linear().col(2);
    const auto vertex = [&](int face, int corner) {
        return Vec3d(mesh.V.row(mesh.F(face, corner)).transpose().cast<double>());
    };
    for (int i = item.part.first_face; i < item.part.first_face + item.part.face_count; ++i) {
        const Vec3d a = vertex(i, 0), normal = (vertex(i, 1) - a).cross(vertex(i, 2) - a);
        if (normal.dot(frame.orthographic() ? backwards : Vec3d(eye - a)) > 0) return false;
    }
    return true;
}

}  // namespace

bool is_turned(const Frame& frame, const DrawItem& item, gpu::Winding winding) {
    if (!item.is_volume()) return false;
    if (winding == gpu::Winding::inward) return true;
    return winding == gpu::Winding::open && item.two_sided && sees_backs_alone(frame, item);
}

}  // namespace easypbr::render
