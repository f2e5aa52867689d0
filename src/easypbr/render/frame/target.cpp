#include "easypbr/render/frame/target.h"

#include <algorithm>

#include "easypbr/core/error.h"

namespace easypbr::render {
namespace {

size_t bytes_of(const PixelRect& area, gl::Format format) {
    return size_t(area.width) * size_t(area.height) * gl::pixel_bytes(format);
}

bool contains(const PixelRect& outer, const PixelRect& inner) {
    return inner.x >= outer.x && inner.y >= outer.y && inner.x + inner.width <= outer.x + outer.width &&
           inner.y + inner.height <= outer.y + outer.height;
}

/// Clearing a vector, or assigning an empty list, would keep its memory.
void free_memory(PooledVector<std::byte>& pixels) {
    PooledVector<std::byte>().swap(pixels);
}

/// Makes room for as many undefined bytes.
void resize(PooledVector<std::byte>& pixels, size_t bytes) {
    if (bytes > pixels.capacity()) free_memory(pixels);  // nothing to copy
    pixels.resize(bytes);
}

}  // namespace

const gl::Texture& Target::attachment() const {
    if (!texture_ && *this) texture_ = gl::Texture(format_, size_.x(), size_.y());
    return texture_;
}

const gl::Texture& Target::texture() const {
    if (newest_ == Newest::host) throw Error("a target is read from its texture before it is uploaded");
    return attachment();
}

const gl::Texture& Target::drawn() const {
    newest_ = Newest::texture;
    return attachment();
}

void Target::write(const PixelRect& area) const {
    area_ = area;
    resize(host_, bytes_of(area, format_));
    newest_ = Newest::host;
    is_complete_ = true;
}

void Target::release() const {
    free_memory(host_);
    area_ = {};
    is_complete_ = false;
    newest_ = Newest::texture;
}

void Target::upload(Transfers& transfers) const {
    if (newest_ != Newest::host) return;
    newest_ = Newest::both;
    copy_to(attachment(), transfers);
}

void Target::copy_to(const gl::Texture& texture, Transfers& transfers) const {
    if (host_.empty()) return;
    texture.upload_area(area_.x, area_.y, area_.width, area_.height, host_);
    transfers.note_upload(host_.size());
}

void Target::download(const PixelRect& area, Transfers& transfers) const {
    if (newest_ != Newest::texture && (is_complete_ || contains(area_, area))) return;
    area_ = area;
    is_complete_ = contains(area, whole());
    resize(host_, bytes_of(area, format_));
    newest_ = Newest::both;
    if (host_.empty()) return;
    if (!reading_) reading_ = gl::Framebuffer({&attachment()});
    reading_.read(0, format_, area.x, area.y, area.width, area.height, host_);
    transfers.note_download(host_.size());
}

void Target::copy_out(const PixelRect& area, std::span<std::byte> values) const {
    const size_t pixel = gl::pixel_bytes(format_), row = size_t(area.width) * pixel;
    for (int y = 0; y < area.height; ++y) {
        const size_t from = size_t(area.y + y - area_.y) * size_t(area_.width) + size_t(area.x - area_.x);
        std::copy_n(host_.data() + from * pixel, row, values.data() + size_t(y) * row);
    }
}

void Target::read_to(std::span<std::byte> values, Transfers& transfers) const {
    download(whole(), transfers);
    const size_t pixel = gl::pixel_bytes(format_), row = size_t(area_.width) * pixel;
    for (int y = 0; y < area_.height; ++y) {
        const size_t to = (size_t(area_.y + y) * size_t(size_.x()) + size_t(area_.x)) * pixel;
        std::copy_n(host_.data() + size_t(y) * row, row, values.data() + to);
    }
}

}  // namespace easypbr::render
