// Triangles into the G-buffer.
#pragma once

#include "easypbr/gpu/mesh_buffers.h"
#include "easypbr/gpu/texture_cache.h"
#include "easypbr/render/frame.h"
#include "easypbr/render/gbuffer.h"
#include "easypbr/render/programs.h"

namespace easypbr::render {

class GeometryPass {
  public:
    /// Clears the G-buffer and draws all meshes of the frame.
    void draw(const Frame& frame, const GBuffer& targets);

    void evict_unused();

    /// The settings' textures, which stand in for every material's own.
    void set_texture_overrides(const Material& overrides) { overrides_ = overrides; }

  private:
    struct Draw;
    void draw_part(const Frame& frame, const Draw& draw);
    void bind_textures(const gl::Program& program, const Material& material);

    gpu::MeshCache meshes_;
    gpu::TextureCache textures_;
    Material overrides_;
    ProgramVariants programs_{"geometry_mesh.vert", "geometry_mesh.frag"};
};

/// A material with the settings' overrides applied.
Material overridden(const Material& material, const MaterialSettings& settings, const Material& textures);

}  // namespace easypbr::render
