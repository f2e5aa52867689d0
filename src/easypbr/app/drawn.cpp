#include "easypbr/app/drawn.h"

#include <utility>

#include "easypbr/core/error.h"

namespace easypbr::app {

Image PictureFinish::apply(Image drawn) const {
    Image picture = lens->is_identity() ? std::move(drawn) : warp(drawn, *lens, exact.get());
    if (backdrop) picture = over_backdrop(picture, *backdrop);
    if (annotate) annotate(picture);
    return picture;
}

bool PendingPicture::is_read() const {
    if (!pixels_.is_pending()) return true;
    const gl::ContextScope scope(*device_->context);
    return pixels_.is_done();
}

Image PendingPicture::take() {
    if (pixels_.is_pending()) {
        const gl::ContextScope scope(*device_->context);
        gl::Context::check();
        pixels_.finish(picture_.bytes());
        gl::Context::check();
    }
    return finish_.apply(std::move(picture_));
}

render::Renderer& Drawn::picture_renderer() const {
    if (picture_ == 0) throw ArgumentError("no picture has been drawn here");
    if (picture_ != device_->picture)
        throw ArgumentError(
            "the picture is outdated: the session has drawn another one since; read it before that");
    return *device_->renderer;
}

render::Renderer& Drawn::surface_renderer() const {
    if (surfaces_ == 0) throw ArgumentError("no surfaces have been drawn here");
    if (surfaces_ != device_->surfaces)
        throw ArgumentError(
            "the surfaces are outdated: the session has drawn something else since; read them before that");
    return *device_->renderer;
}

bool Drawn::is_in_memory() const {
    return tiled_ || picture_renderer().has_picture_in_memory();
}

Image Drawn::picture() const {
    if (tiled_) return finish_.apply(*tiled_);
    const render::Renderer& renderer = picture_renderer();
    const gl::ContextScope scope(*device_->context);
    Image picture = renderer.read_picture();
    gl::Context::check();
    return finish_.apply(std::move(picture));
}

PendingPicture Drawn::read_later(gl::Readback memory) const {
    if (tiled_) return {device_, *tiled_, std::move(memory), finish_};
    const render::Renderer& renderer = picture_renderer();
    const gl::ContextScope scope(*device_->context);
    Image picture = renderer.begin_reading(memory);
    return {device_, std::move(picture), std::move(memory), finish_};
}

void Drawn::wait() const {
    if (tiled_) return;
    const render::Renderer& renderer = picture_renderer();
    const gl::ContextScope scope(*device_->context);
    renderer.read_picture(1, 1);
}

const gl::Texture& Drawn::texture() const {
    if (tiled_) throw ArgumentError("the picture was drawn in tiles: there is no texture of it");
    return picture_renderer().picture();
}

render::SurfaceFrame Drawn::surfaces() const {
    const render::Renderer& renderer = surface_renderer();
    const gl::ContextScope scope(*device_->context);
    render::SurfaceFrame surfaces = renderer.read_surfaces();
    gl::Context::check();
    return surfaces;
}

Image Drawn::layer(render::Layer layer) const {
    const render::Renderer& renderer = surface_renderer();
    const gl::ContextScope scope(*device_->context);
    Image pixels = renderer.read_layer(layer);
    gl::Context::check();
    return pixels;
}

std::vector<uint8_t> Drawn::coverage(const render::PixelRect& area,
                                     const std::function<bool(size_t, int)>& wanted) const {
    render::Renderer& renderer = surface_renderer();
    const gl::ContextScope scope(*device_->context);
    return renderer.coverage(area, wanted);
}

std::vector<render::ScreenReach> Drawn::reaches() const {
    render::Renderer& renderer = surface_renderer();
    const gl::ContextScope scope(*device_->context);
    return renderer.reaches();
}

std::vector<bool> Drawn::blended() const {
    return surface_renderer().blended();
}

const render::GBuffer& Drawn::targets() const {
    return surface_renderer().uploaded_targets();
}

}  // namespace easypbr::app
