// Triangles into the G-buffer without the driver's rasteriser: for machines without a GPU.
#pragma once

#include <map>
#include <tuple>

#include "easypbr/render/draw_list.h"
#include "easypbr/render/gbuffer.h"
#include "easypbr/render/visibility.h"

namespace easypbr::render {

/// Draws what GeometryPass draws, into the same targets, several times faster than a CPU rasteriser behind
/// OpenGL: the nearest triangle per pixel first, then the surface of each pixel once. Surfaces with textures,
/// emission or alpha, and geometry that reaches before the near plane, are left to GeometryPass.
class SoftwareGeometryPass {
  public:
    /// Whether draw() can draw these items.
    static bool handles(const std::vector<DrawItem>& items);

    /// Fills the G-buffer and narrows the frame's covered rectangle; false, with both unchanged, when
    /// something would have to be clipped.
    bool draw(Frame& frame, const std::vector<DrawItem>& items, const GBuffer& targets);

    void evict_unused();

  private:
    /// What is known of a mesh beyond its data.
    struct Knowledge {
        Array3f N;
        bool normals_agree = true;    ///< the winding tells the normals' side
        bool closed_outward = false;  ///< back faces need not be drawn; found out when a mesh is drawn again
        int frames = 0;
        bool used = false;
    };
    /// Pixels of the covered area in the targets' formats.
    struct Pixels {
        std::vector<uint16_t> albedo, normal;
        std::vector<uint8_t> material;
        std::vector<float> depth;
        void resize(size_t count);
    };
    struct Surface;
    const Knowledge& knowledge_of(const MeshData& mesh);
    void resolve(const Frame& frame, const std::vector<Surface>& surfaces);
    void upload(const GBuffer& targets);

    std::map<std::tuple<uint64_t, uint64_t, uint64_t>, Knowledge> knowledge_;
    VisibilityBuffer visibility_;
    Pixels pixels_;
};

}  // namespace easypbr::render
