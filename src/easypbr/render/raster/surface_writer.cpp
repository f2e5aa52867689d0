#include "easypbr/render/raster/surface_writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "easypbr/core/octahedral.h"

namespace easypbr::render {
namespace {

uint16_t unorm16(float v) {
    return uint16_t(std::lrintf(std::clamp(v, 0.0f, 1.0f) * 65535.0f));
}
uint8_t unorm8(float v) {
    return uint8_t(std::lrintf(std::clamp(v, 0.0f, 1.0f) * 255.0f));
}

}  // namespace

SurfaceWriter::SurfaceWriter(const GBuffer& targets, const PixelRect& area, bool with_ids) : area_(area) {
    targets.write(area, with_ids);
    albedo_ = targets.albedo.pixels<uint16_t>();
    normal_ = targets.normal.pixels<uint16_t>();
    material_ = targets.material.pixels<uint8_t>();
    depth_ = targets.depth.pixels<float>();
    if (!with_ids) return;
    id_ = targets.id.pixels<uint32_t>();
    element_ = targets.element.pixels<uint32_t>();
}

void SurfaceWriter::put(size_t i, const SurfacePixel& p) {
    const Vec2 normal = oct_encode(p.normal) * 0.5f + Vec2(0.5f, 0.5f);
    depth_[i] = p.depth;
    for (size_t c = 0; c < 3; ++c) albedo_[4 * i + c] = unorm16(p.albedo[Eigen::Index(c)]);
    albedo_[4 * i + 3] = 65535;
    normal_[2 * i] = unorm16(normal.x());
    normal_[2 * i + 1] = unorm16(normal.y());
    const uint8_t material[4] = {unorm8(p.metallic), unorm8(p.roughness), 255, uint8_t(p.kind)};
    std::copy_n(material, 4, &material_[4 * i]);
    if (id_.empty()) return;
    id_[i] = p.object + 1;
    element_[i] = (p.element + 1) | (p.is_point ? point_element : 0);
}

native::VisibleTriangles SurfaceWriter::target_of(const SurfacePixel& p) const {
    native::VisibleTriangles to;
    const uint16_t albedo[4] = {unorm16(p.albedo[0]), unorm16(p.albedo[1]), unorm16(p.albedo[2]), 65535};
    const uint8_t material[4] = {unorm8(p.metallic), unorm8(p.roughness), 255, uint8_t(p.kind)};
    std::memcpy(&to.albedo, albedo, sizeof albedo);
    std::memcpy(&to.material, material, sizeof material);
    to.id = p.object + 1;
    to.albedos = reinterpret_cast<uint64_t*>(albedo_.data());
    to.normals = reinterpret_cast<uint32_t*>(normal_.data());
    to.materials = reinterpret_cast<uint32_t*>(material_.data());
    to.depths = depth_.data();
    to.ids = id_.data();
    to.elements = element_.data();
    return to;
}

void SurfaceWriter::clear() {
    std::ranges::fill(depth_, 0.0f);
    std::ranges::fill(id_, 0u);
    std::ranges::fill(element_, 0u);
}

}  // namespace easypbr::render
