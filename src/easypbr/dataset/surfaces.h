// What each pixel of a picture sees, in numbers: exact points on the user's own faces.
#pragma once

#include <vector>

#include "easypbr/app/session.h"

namespace easypbr::dataset {

/// A surface frame (render/surface_frame.h) brought into the picture's pixels, with the point that the ray
/// through each pixel's centre meets. Row 0 on top.
struct Surfaces {
    Vec2i size{0, 0};
    Camera camera;                 ///< of the picture, with its distortion
    SceneSnapshot scene;           ///< with the objects' own data
    std::vector<bool> only_faces;  ///< as in render::SurfaceFrame, like the next five
    std::vector<double> voxel_sizes;
    std::vector<uint32_t> object, element, part;
    std::vector<uint8_t> is_face;
    std::vector<Vec3> position;      ///< in the camera's frame, OpenCV's axes; z is 0 where there is nothing
    std::vector<Vec3> barycentrics;  ///< weights of the corners of the face; 0 where there is none
    std::vector<Vec2> slopes;        ///< x/z and y/z of the ray; for orthographic cameras x and y

    bool covered(size_t pixel) const { return object[pixel] != 0; }
    const MeshData& mesh_of(size_t pixel) const { return *scene.objects[object[pixel] - 1].mesh; }
    bool on_face(size_t pixel) const { return covered(pixel) && is_face[pixel]; }
    size_t element_of(size_t pixel) const { return element[pixel] - 1; }
};

/// The rays through places of the device's coordinates, x to the right and y upwards, without a lens:
/// (place + shift) * scale are x/z and y/z in the camera's frame (OpenCV's axes); for orthographic cameras x
/// and y.
struct RaySlopes {
    Vec2d shift, scale;
    Vec2 at(const Vec2d& place) const { return ((place + shift).cwiseProduct(scale)).cast<float>(); }
};
RaySlopes ray_slopes(const Camera& camera, Vec2i size);

/// From the camera's frame (OpenCV's axes) to the frame of an object's V.
Eigen::Affine3d cv_from_mesh(const Camera& camera, const SceneSnapshot::Object& object);

/// The inverse of a pose; of one that flattens, the pseudoinverse: axes that it flattens are 0.
Eigen::Affine3d inverse_pose(const Eigen::Affine3d& T);

/// Pixel (centres at integers) of a point in the camera's frame with z > 0, through the lens.
Vec2d project(const Camera& camera, Vec2i size, const Vec3d& point_cv);

/// The slope up to which a camera's lens moves points outward the further out they are, in all directions;
/// infinite where it always does. Beyond, its polynomial folds back and says nothing of a real lens.
double lens_reach(const Camera& camera);

/// Whether project() tells where a point is: before the camera, within the reach of its lens.
bool is_projected(const Camera& camera, double lens_reach, const Vec3d& point_cv);

/// A face or a disc is met in double precision by the ray itself, and a splat where it is densest along it,
/// so that the result does not have the rasteriser's rounding; other points have the depth that was drawn.
Surfaces surfaces_of(render::SurfaceFrame frame, const Camera& camera, const app::LensMap& lens);

}  // namespace easypbr::dataset
