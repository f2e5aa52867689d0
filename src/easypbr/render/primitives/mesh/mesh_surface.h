// The surface of a pixel that the native rasteriser found a triangle in.
#pragma once

#include "easypbr/render/raster/visible_surfaces.h"

namespace easypbr::render {

/// What is known of a mesh beyond its data.
struct MeshFacts {
    Array3f N;
    bool normals_agree = true;    ///< the winding tells the normals' side
    bool closed_outward = false;  ///< from outside, back faces need not be drawn
    Box3d box;                    ///< of the vertices, when it is closed
};

/// A mesh item with all that its pixels need.
class MeshSurface final : public VisibleItem {
  public:
    MeshSurface(const DrawItem& item, const MeshFacts& facts, const Mat4d& clip_from_mesh);

    /// Of the triangle `face` of the item's part; its depth is computed anew, from vertices that are not
    /// snapped.
    SurfacePixel at(uint32_t face, double ndc_x, double ndc_y, float depth) const override;

    bool resolve(const Frame& frame, const DrawItem& item, std::span<const native::VisiblePixel> pixels,
                 int y, SurfaceWriter& writer) const override;

  private:
    struct Hit;
    Hit intersect(const float* const (&corner)[3], double ndc_x, double ndc_y) const;
    Vec3 face_normal(const int32_t* f) const;
    Vec3 normal(const int32_t* f, const Hit& hit) const;
    Vec3 albedo(const int32_t* f, const Hit& hit) const;
    double clip(int row, const float* p) const;

    const DrawItem* item_;
    const MeshFacts* facts_;
    double clip_[4][4];
    Mat3 normal_from_mesh_;
    bool mirrored_;
};

}  // namespace easypbr::render
