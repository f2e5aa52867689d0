#include "easypbr/app/tiled_picture.h"

#include <algorithm>
#include <utility>

#include "easypbr/core/step_progress.h"

namespace easypbr::app {
namespace {

using render::Tile;

/// Puts a rectangle of an image where the tile's inner part lies in the picture, which is made with the
/// first.
void place(const Image& from, Vec2i corner, const Tile& tile, Vec2i size, Image& picture) {
    if (picture.empty()) picture = Image(size.x(), size.y(), from.channels(), from.type());
    const size_t pixel = size_t(from.channels()) * size_of(from.type());
    for (int y = 0; y < tile.inner.height; ++y) {
        const std::byte* row = from.bytes().data() + size_t(corner.y() + y) * from.row_bytes();
        std::copy_n(row + size_t(corner.x()) * pixel, size_t(tile.inner.width) * pixel,
                    picture.bytes().data() + size_t(tile.inner.y + y) * picture.row_bytes() +
                        size_t(tile.inner.x) * pixel);
    }
}

/// Where the inner part lies in what is drawn.
Vec2i corner_of(const Tile& tile) {
    return {tile.inner.x - tile.outer.x, tile.inner.y - tile.outer.y};
}

template <class T>
void place(const std::vector<T>& from, const Tile& tile, Vec2i size, std::vector<T>& picture) {
    picture.resize(size_t(size.x()) * size_t(size.y()));
    const Vec2i corner = corner_of(tile);
    for (int y = 0; y < tile.inner.height; ++y) {
        const size_t row = size_t(corner.y() + y) * size_t(tile.outer.width) + size_t(corner.x()),
                     to = size_t(tile.inner.y + y) * size_t(size.x()) + size_t(tile.inner.x);
        std::copy_n(from.data() + row, tile.inner.width, picture.data() + to);
    }
}

void place(render::SurfaceFrame from, const Tile& tile, Vec2i size, render::SurfaceFrame& picture) {
    const auto place_pixels = [&](auto& of_tile, auto& of_picture) {
        place(of_tile, tile, size, of_picture);
        of_tile = std::move(of_picture);
    };
    place_pixels(from.depth, picture.depth);
    place_pixels(from.object, picture.object);
    place_pixels(from.element, picture.element);
    place_pixels(from.is_face, picture.is_face);
    place_pixels(from.part, picture.part);
    from.size = size;
    // All that is not of pixels is the same in every tile.
    picture = std::move(from);
}

}  // namespace

TiledPicture::TiledPicture(const SceneSnapshot& scene_, const ResolvedSettings& resolved_,
                           const render::DrawOptions& options_, const render::SettingsImages& images_,
                           const render::TileLimits& limits)
    : scene(scene_),
      resolved(resolved_),
      options(options_),
      images(images_),
      guard(render::guard_of(scene_, resolved_, options_.size)),
      tiles(render::tiles_of(options_.size, guard.pixels, limits)) {}

void TiledPicture::draw_tile(render::Renderer& renderer, const Tile& tile) const {
    render::DrawOptions part = options;
    part.picture_size = options.size;
    part.size = {tile.outer.width, tile.outer.height};
    part.origin = {tile.outer.x, tile.outer.y};
    part.reach = guard.reach;
    part.time_share = 1 / double(tiles.size());
    renderer.draw(scene, resolved, part, images);
}

Image TiledPicture::draw(render::Renderer& renderer, Image& exact) const {
    Image picture;
    StepProgress progress("picture", "tile", int(tiles.size()));
    int drawn_tiles = 0;
    for (const Tile& tile : tiles) {
        draw_tile(renderer, tile);
        progress.done(++drawn_tiles);
        const Vec2i corner = corner_of(tile);
        const Image drawn =
            renderer.read_picture({corner.x(), corner.y(), tile.inner.width, tile.inner.height});
        place(drawn, {0, 0}, tile, options.size, picture);
        if (const Image& part = renderer.exact_pixels(); !part.empty())
            place(part, corner, tile, options.size, exact);
    }
    return picture;
}

std::vector<Image> TiledPicture::draw_layers(render::Renderer& renderer,
                                             const std::vector<render::Layer>& layers,
                                             render::SurfaceFrame& surfaces) const {
    std::vector<Image> pictures(layers.size());
    for (const Tile& tile : tiles) {
        draw_tile(renderer, tile);
        for (size_t i = 0; i < layers.size(); ++i)
            place(renderer.read_layer(layers[i]), corner_of(tile), tile, options.size, pictures[i]);
        if (options.surfaces) place(renderer.read_surfaces(), tile, options.size, surfaces);
    }
    return pictures;
}

}  // namespace easypbr::app
