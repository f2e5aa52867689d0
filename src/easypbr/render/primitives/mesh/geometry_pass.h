// Triangles into the G-buffer.
#pragma once

#include "easypbr/gpu/mesh_buffers.h"
#include "easypbr/gpu/texture_cache.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/programs.h"

namespace easypbr::render {

class GeometryPass {
  public:
    /// The caches are shared with other passes, must outlive this one, and are emptied by their owner.
    GeometryPass(gpu::MeshCache& meshes, gpu::TextureCache& textures)
        : meshes_(meshes), textures_(textures) {}

    /// Clears the G-buffer, unless a layer is drawn, and draws all items.
    void draw(const Frame& frame, const std::vector<DrawItem>& items, const GBuffer& targets,
              const SurfaceOutputs& outputs);

  private:
    void draw_item(const Frame& frame, const DrawItem& item, const gpu::MeshBuffers& buffers,
                   const SurfaceOutputs& outputs, bool emission);

    const gl::Program& program_of(const DrawItem& item, const std::vector<std::string>& defines);

    gpu::MeshCache& meshes_;
    gpu::TextureCache& textures_;
    ProgramVariants programs_{"geometry_mesh.vert", "geometry_mesh.frag"};
};

}  // namespace easypbr::render
