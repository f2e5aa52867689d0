// Pictures that are too large to be drawn at once, put together from tiles.
#pragma once

#include <vector>

#include "easypbr/core/image.h"
#include "easypbr/render/pipeline/renderer.h"
#include "easypbr/render/pipeline/tiles.h"

namespace easypbr::app {

/// Largest number of pixels of a picture.
inline constexpr int64_t max_picture_pixels = int64_t(1) << 30;

/// What a picture is drawn of, settings resolved for the whole of it.
struct TiledPicture {
    const SceneSnapshot& scene;
    const ResolvedSettings& resolved;
    const render::DrawOptions& options;
    const render::SettingsImages& images;
    render::Guard guard;
    std::vector<render::Tile> tiles;

    /// Throws ArgumentError, see render::tiles_of().
    TiledPicture(const SceneSnapshot& scene, const ResolvedSettings& resolved,
                 const render::DrawOptions& options, const render::SettingsImages& images,
                 const render::TileLimits& limits);

    /// There is nothing to put together: the renderer draws it at once.
    bool is_whole() const { return tiles.size() == 1; }

    /// Both need the context current. `exact`: render::Renderer::exact_pixels() of the whole picture, where
    /// options.exact_pixels asks for them.
    Image draw(render::Renderer& renderer, Image& exact) const;
    /// `surfaces`: of the whole picture, where options.surfaces asks for them.
    std::vector<Image> draw_layers(render::Renderer& renderer, const std::vector<render::Layer>& layers,
                                   render::SurfaceFrame& surfaces) const;

  private:
    void draw_tile(render::Renderer& renderer, const render::Tile& tile) const;
};

}  // namespace easypbr::app
