// Triangles into the G-buffer by the driver.
#pragma once

#include <span>

#include "easypbr/gpu/texture_cache.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/programs.h"
#include "easypbr/render/primitives/mesh/mesh_buffers.h"

namespace easypbr::render {

class MeshPass {
  public:
    /// The caches are shared with others, must outlive this one, and are emptied by their owner.
    MeshPass(MeshCache& meshes, gpu::TextureCache& textures) : meshes_(meshes), textures_(textures) {}

    /// Adds the items to what the textures hold.
    void draw(const Frame& frame, std::span<const DrawItem> items, const GBuffer& targets,
              const SurfaceOutputs& outputs);

  private:
    const gl::Program& program_of(const DrawItem& item, const std::vector<std::string>& defines);
    void draw_item(const Frame& frame, const DrawItem& item, const MeshBuffers& buffers,
                   const SurfaceOutputs& outputs, bool emission);

    MeshCache& meshes_;
    gpu::TextureCache& textures_;
    ProgramVariants programs_{"geometry_mesh.vert", "geometry_mesh.frag"};
};

}  // namespace easypbr::render
