// Triangles and points into the G-buffer without the driver's rasteriser: for machines without a GPU.
#pragma once

#include <map>
#include <tuple>

#include "easypbr/render/draw_list.h"
#include "easypbr/render/gbuffer.h"
#include "easypbr/render/mesh_surface.h"
#include "easypbr/render/point_surface.h"
#include "easypbr/render/programs.h"
#include "easypbr/render/visibility.h"

namespace easypbr::render {

/// Draws into the targets of GeometryPass, several times faster than a CPU rasteriser behind OpenGL: the
/// nearest triangle or point per pixel first, then the surface of each pixel once.
class SoftwareGeometryPass {
  public:
    /// Whether draw() can draw these meshes and points: plain ones, without textures, emission or alpha.
    static bool handles(const DrawList& list);
    /// The same of the points alone.
    static bool handles_points(const DrawList& list);

    /// Fills the G-buffer with the list's meshes and points and narrows the frame's covered rectangle; false,
    /// with both unchanged, when a mesh would have to be clipped.
    bool draw(Frame& frame, const DrawList& list, const GBuffer& targets);

    /// Adds the list's points to what the G-buffer holds.
    void draw_points_over(const Frame& frame, const DrawList& list, const GBuffer& targets);

    void evict_unused();

  private:
    /// Pixels of the covered area in the targets' formats.
    struct Pixels {
        std::vector<uint16_t> albedo, normal;
        std::vector<uint8_t> material;
        std::vector<float> depth;
        std::vector<uint32_t> id, element;
        void resize(size_t count, bool with_ids);
    };
    struct Surface;
    struct Spacing {
        double value = 0;
        bool used = false;
    };
    const MeshKnowledge& knowledge_of(const MeshData& mesh);
    double spacing_of(const MeshData& mesh);
    bool add_meshes(const Frame& frame, const DrawList& list, std::vector<Surface>& surfaces);
    void add_points(const Frame& frame, const DrawList& list, std::vector<Surface>& surfaces);
    void resolve(const Frame& frame, const std::vector<Surface>& surfaces);
    void upload(const Frame& frame, const GBuffer& targets) const;

    std::map<std::tuple<uint64_t, uint64_t, uint64_t>, MeshKnowledge> knowledge_;
    std::map<uint64_t, Spacing> spacings_;
    VisibilityBuffer visibility_;
    Pixels pixels_;
    GBuffer staging_;  ///< what draw_points_over() adds
    ProgramVariants composite_{"screen_triangle.vert", "composite_surface.frag"};
};

}  // namespace easypbr::render
