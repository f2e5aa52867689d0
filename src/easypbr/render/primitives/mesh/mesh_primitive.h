// Triangle meshes, voxels among them.
#pragma once

#include "easypbr/render/primitives/mesh/mesh_pass.h"
#include "easypbr/render/primitives/mesh/mesh_shadows.h"
#include "easypbr/render/primitives/mesh/native_meshes.h"
#include "easypbr/render/primitives/primitive.h"

namespace easypbr::render {

class MeshPrimitive final : public Primitive {
  public:
    explicit MeshPrimitive(DataCaches& caches)
        : pass_(buffers_, caches.textures),
          native_(caches.closed_meshes, caches.textures),
          shadows_(buffers_, native_, caches) {}

    DrawMode mode() const override { return DrawMode::mesh; }
    void draw(const Frame& frame, DrawItems items, const GBuffer& targets,
              const SurfaceOutputs& outputs) override {
        pass_.draw(frame, items, targets, outputs);
    }
    bool is_native(DrawItems items) const override { return NativeMeshes::draws(items); }
    bool has_native_layers(DrawItems items) const override { return NativeMeshes::draws_layers(items); }
    bool rasterise(const Frame& frame, DrawItems items, ExtensionSet extensions,
                   VisibleSurfaces& surfaces) override {
        return native_.rasterise(frame, items, extensions, surfaces);
    }
    bool cover(const Frame& frame, DrawItems items, std::span<uint8_t> covered) override {
        return native_.cover(frame, items, covered);
    }
    void draw_backs(const Frame& frame, DrawItems items, const GBuffer& targets,
                    const SurfaceOutputs& outputs) override;
    ShadowShape shadow_shape(const DrawItem& item) override {
        return {{item.mesh().V.revision(), item.mesh().F.revision()}, {}};
    }
    void rasterise_shadows(const ShadowView& view, Casters& casters, ShadowDepths& depths) override {
        shadows_.rasterise(view, casters, depths);
    }
    bool has_native_tints(DrawItems items) const override { return MeshShadows::has_native_tints(items); }
    void rasterise_tints(const ShadowView& view, const Casters& casters, TintLayer& layer) override {
        shadows_.rasterise_tints(view, casters, layer);
    }
    void draw_shadows(const ShadowLayer& layer, const Casters& casters) override {
        shadows_.draw(layer, casters);
    }
    void add_to(RayGeometry& geometry, const DrawItem& item) override { geometry.add_faces(item); }
    std::unique_ptr<HitSurface> hit_surface(const ResolvedSettings& resolved, const DrawItem& item) override {
        return native_.hit_surface(resolved, item);
    }
    void evict_unused() override {
        buffers_.evict_unused();
        native_.evict_unused();
    }

  private:
    MeshCache buffers_;
    MeshPass pass_;
    NativeMeshes native_;
    MeshShadows shadows_;
};

}  // namespace easypbr::render
