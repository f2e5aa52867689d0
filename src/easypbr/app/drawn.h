// What a session drew: a value, whose pixels stay with the renderer until they are read.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "easypbr/app/backdrop.h"
#include "easypbr/app/lens.h"
#include "easypbr/core/image.h"
#include "easypbr/gl/context.h"
#include "easypbr/gl/readback.h"
#include "easypbr/render/pipeline/renderer.h"

namespace easypbr::app {

/// A context with its renderer, and numbers of what the renderer's targets hold.
struct Device {
    std::unique_ptr<gl::Context> context;
    std::unique_ptr<render::Renderer> renderer;
    uint64_t picture = 0, surfaces = 0;  ///< drawn last; another number is another drawing
    uint64_t sum = 0;                    ///< that frames are added to; another number is another one
};

/// What becomes of a picture's pixels once they are read: the lens, the image behind it, then the annotation.
struct PictureFinish {
    std::shared_ptr<const LensMap> lens = std::make_shared<const LensMap>();
    std::shared_ptr<const Image> exact;    ///< render::Renderer::exact_pixels(), where a lens warps; or null
    std::optional<Backdrop> backdrop;      ///< of a picture drawn without its background image
    std::function<void(Image&)> annotate;  ///< empty: there is no annotation

    Image apply(Image drawn) const;
};

/// A picture on its way to memory. Whatever is drawn meanwhile does not change it.
class PendingPicture {
  public:
    /// `picture` is filled by `pixels`, where that is pending.
    PendingPicture(std::shared_ptr<Device> device, Image picture, gl::Readback pixels, PictureFinish finish)
        : device_(std::move(device)),
          picture_(std::move(picture)),
          pixels_(std::move(pixels)),
          finish_(std::move(finish)) {}

    /// Whether take() would not have to wait for the driver.
    bool is_read() const;
    /// Drawn::picture(), bit for bit. To be called once.
    Image take();
    /// For the next Drawn::read_later(), which uses its memory again. After take().
    gl::Readback take_memory() { return std::move(pixels_); }

  private:
    std::shared_ptr<Device> device_;
    Image picture_;
    gl::Readback pixels_;
    PictureFinish finish_;
};

/// Camera, lens and annotation are kept here. Pixels are read from the renderer, which keeps them until the
/// session draws again: what is asked for later, or was not drawn, is an ArgumentError; gl::ContextLost when
/// they went with the context. Surfaces that are
/// drawn alone leave the picture that was drawn before.
class Drawn {
  public:
    /// Nothing.
    Drawn() = default;

    /// What the picture shows; what is drawn of a warped camera is lens().drawn.
    const Camera& camera() const { return camera_; }
    /// From the pixels of the picture to those that were drawn.
    const LensMap& lens() const { return *finish_.lens; }
    const std::shared_ptr<const LensMap>& shared_lens() const { return finish_.lens; }
    /// Whether picture() draws legends or colour bars.
    bool is_annotated() const { return bool(finish_.annotate); }
    /// Pixels are those of texture(): nothing becomes of them when they are read.
    bool is_plain() const { return lens().is_identity() && !is_annotated() && !tiled_; }

    /// Whether it is in host memory: picture() needs no driver.
    bool is_in_memory() const;
    /// RGBA, row 0 on top.
    Image picture() const;
    /// The same, without waiting; `memory` is used again. What was drawn in tiles is there at once.
    PendingPicture read_later(gl::Readback memory = {}) const;
    /// Waits until the driver has drawn it: for measuring.
    void wait() const;
    /// The picture as it was drawn, before lens and annotation. Throws ArgumentError for one in tiles too.
    const gl::Texture& texture() const;

    /// What the pixels' centres see, as it was drawn: of a warped camera a wider picture.
    render::SurfaceFrame surfaces() const;
    /// A layer of the surfaces, as it was drawn.
    Image layer(render::Layer layer) const;
    /// See render::Renderer::coverage().
    std::vector<uint8_t> coverage(const render::PixelRect& area,
                                  const std::function<bool(size_t object, int first_face)>& wanted) const;
    /// See render::Renderer::reaches().
    std::vector<render::ScreenReach> reaches() const;
    /// See render::Renderer::blended().
    std::vector<bool> blended() const;
    /// What layer() reads.
    const render::GBuffer& targets() const;

  private:
    friend class Session;
    render::Renderer& picture_renderer() const;
    render::Renderer& surface_renderer() const;

    std::shared_ptr<Device> device_;
    uint64_t picture_ = 0, surfaces_ = 0;  ///< numbers in the device; 0: there is none
    Camera camera_;
    PictureFinish finish_;
    std::shared_ptr<const Image> tiled_;  ///< the picture, where it was drawn in tiles
};

}  // namespace easypbr::app
