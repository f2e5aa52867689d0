#include "easypbr/render/raster/surface_writer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "easypbr/core/octahedral.h"
#include "easypbr/core/parallel.h"

namespace easypbr::render {
namespace {

uint16_t unorm16(float v) {
    return uint16_t(std::lrintf(std::clamp(v, 0.0f, 1.0f) * 65535.0f));
}
uint8_t unorm8(float v) {
    return uint8_t(std::lrintf(std::clamp(v, 0.0f, 1.0f) * 255.0f));
}

// What a pixel holds of a surface, in the formats of the targets.
uint64_t packed_albedo(const SurfacePixel& p) {
    const uint16_t albedo[4] = {unorm16(p.albedo[0]), unorm16(p.albedo[1]), unorm16(p.albedo[2]),
                                unorm16(p.alpha)};
    return std::bit_cast<uint64_t>(albedo);
}
uint32_t packed_normal(const SurfacePixel& p) {
    const Vec2 normal = oct_encode(p.normal) * 0.5f + Vec2(0.5f, 0.5f);
    return unorm16(normal.x()) | uint32_t(unorm16(normal.y())) << 16;
}
uint32_t packed_material(const SurfacePixel& p) {
    const uint8_t material[4] = {unorm8(p.metallic), unorm8(p.roughness), 255, uint8_t(p.kind)};
    return std::bit_cast<uint32_t>(material);
}

}  // namespace

SurfaceWriter::SurfaceWriter(const GBuffer& targets, const PixelRect& area, SurfaceContents contents)
    : area_(area) {
    targets.write(area, contents);
    albedo_ = targets.albedo.pixels<uint64_t>();
    normal_ = targets.normal.pixels<uint32_t>();
    material_ = targets.material.pixels<uint32_t>();
    depth_ = targets.depth.pixels<float>();
    if (contents.emission) emission_ = targets.emission.pixels<float>();
    for (int i = 0; contents.extensions && i < 2; ++i)
        extensions_[i] = targets.extension[i].pixels<uint32_t>();
    if (!contents.ids) return;
    id_ = targets.id.pixels<uint32_t>();
    element_ = targets.element.pixels<uint32_t>();
}

void SurfaceWriter::put(size_t i, const SurfacePixel& p) {
    depth_[i] = p.depth;
    albedo_[i] = packed_albedo(p);
    normal_[i] = packed_normal(p);
    material_[i] = packed_material(p);
    // What emits is written by its shader.
    if (!emission_.empty()) std::copy_n(std::array{0.0f, 0.0f, 0.0f, 1.0f}.data(), 4, &emission_[4 * i]);
    if (id_.empty()) return;
    id_[i] = p.object + 1;
    element_[i] = (p.element + 1) | (p.is_point ? point_element : 0);
}

void SurfaceWriter::set_targets(native::VisibleTriangles& to, const SurfacePixel& p) const {
    to.albedo = packed_albedo(p);
    to.material = packed_material(p);
    to.id = p.object + 1;
    to.x = area_.x;
    to.y = area_.y;
    to.width = area_.width;
    to.albedos = albedo_.data();
    to.normals = normal_.data();
    to.materials = material_.data();
    to.depths = depth_.data();
    to.ids = id_.data();
    to.elements = element_.data();
    to.emission = emission_.empty() ? nullptr : emission_.data();
    for (int i = 0; i < 2; ++i) to.extensions[i] = extensions_[i].data();
}

void SurfaceWriter::clear() {
    const auto fill = [](auto values) {
        parallel_chunks(values.size(), size_t(1) << 18, [&](size_t begin, size_t end) {
            std::ranges::fill(values.subspan(begin, end - begin), 0);
        });
    };
    fill(depth_);
    fill(id_);
    fill(element_);
    fill(emission_);
}

SurfaceFill::SurfaceFill(const GBuffer& targets, const SurfacePixel& surface)
    : area_(targets.depth.area()),
      albedo_(targets.albedo.pixels<uint64_t>()),
      normal_(targets.normal.pixels<uint32_t>()),
      material_(targets.material.pixels<uint32_t>()),
      depth_(targets.depth.pixels<float>()),
      own_albedo_(packed_albedo(surface)),
      own_normal_(packed_normal(surface)),
      own_material_(packed_material(surface)) {
    if (targets.emission.is_ahead()) emission_ = targets.emission.pixels<float>();
}

void SurfaceFill::put(int x, int y, float depth) {
    const size_t i = size_t(y - area_.y) * size_t(area_.width) + size_t(x - area_.x);
    if (!(depth > depth_[i])) return;
    depth_[i] = depth;
    albedo_[i] = own_albedo_;
    normal_[i] = own_normal_;
    material_[i] = own_material_;
    if (!emission_.empty()) std::fill_n(&emission_[4 * i], 4, 0.0f);
}

}  // namespace easypbr::render
