#include "easypbr/render/raytrace/ray_surface.h"

#include <algorithm>
#include <cmath>

#include "easypbr/core/color.h"
#include "easypbr/render/raytrace/ray_scene.h"

namespace easypbr::render {
namespace {

int wrapped(float coordinate, int size, Wrap wrap) {
    if (!std::isfinite(coordinate)) return 0;
    const float period = wrap == Wrap::mirror ? 2.0f : 1.0f;
    float c = wrap == Wrap::clamp ? std::clamp(coordinate, 0.0f, 1.0f)
                                  : coordinate - period * std::floor(coordinate / period);
    if (c > 1) c = 2 - c;
    return std::clamp(int(c * float(size)), 0, size - 1);
}

/// One channel from 0 to 1, as the textures of shaders hold it: colours of integers decoded from sRGB, other
/// integers scaled.
float value_of(const Image& image, int x, int y, int channel, bool color) {
    const int c = std::min(channel, image.channels() - 1);
    switch (image.type()) {
        case PixelType::u8: {
            const uint8_t code = image.at<uint8_t>(x, y)[c];
            return color ? srgb8_table()[code] : float(code) / 255;
        }
        case PixelType::u16: {
            const float code = float(image.at<uint16_t>(x, y)[c]) / 65535;
            return color ? linear_from_srgb(code) : code;
        }
        default: {
            const float value = image.at<float>(x, y)[c];
            return std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : 0;
        }
    }
}

/// The texel of a texture at a place on a surface.
class Texel {
  public:
    Texel(const Texture& texture, const Vec2& uv) : image_(*texture.image) {
        const Vec3 at = texture.uv_transform * Vec3(uv.x(), uv.y(), 1);
        x_ = wrapped(at.x(), image_.width(), texture.wrap_u);
        y_ = image_.height() - 1 - wrapped(at.y(), image_.height(), texture.wrap_v);
    }
    /// Of grey images the grey.
    Vec3 color() const {
        const bool grey = image_.channels() < 3;
        const auto value = [&](int c) { return value_of(image_, x_, y_, grey ? 0 : c, true); };
        return {value(0), value(1), value(2)};
    }
    float channel(int channel) const { return value_of(image_, x_, y_, channel, false); }
    float alpha() const {
        const int c = image_.channels();
        return c == 2 || c == 4 ? value_of(image_, x_, y_, c - 1, false) : 1.0f;
    }

  private:
    const Image& image_;
    int x_ = 0, y_ = 0;
};

/// An attribute of a face's vertices between them.
template <class Rows>
auto interpolated(const Rows& rows, const Array3i& F, int face, float u, float v) {
    using Result = Eigen::Matrix<float, Rows::ColsAtCompileTime, 1>;
    return Result((1 - u - v) * rows.row(F(face, 0)) + u * rows.row(F(face, 1)) + v * rows.row(F(face, 2)));
}

bool is_face(const DrawItem& item) {
    return !item.mesh().F.empty() && item.part.face_count > 0;
}

/// Colour and alpha of the vertices; white where none count.
Vec4 vertex_color(const DrawItem& item, int element, float u, float v) {
    const MeshData& mesh = item.mesh();
    if (!item.with_colors || mesh.C.empty()) return Vec4::Ones();
    const auto of_vertex = [&](Eigen::Index vertex) {
        const Vec3 code = mesh.C.row(vertex).head<3>().cwiseMax(0.0f).cwiseMin(1.0f).transpose();
        Vec4 color;
        color << linear_from_srgb(code), (mesh.C.cols() > 3 ? mesh.C(vertex, 3) : 1.0f);
        return color;
    };
    if (!is_face(item)) return of_vertex(std::min<Eigen::Index>(element, mesh.C.rows() - 1));
    // Between vertices light is mixed, not its codes.
    const auto of_corner = [&](int corner) { return of_vertex(mesh.F(element, corner)); };
    return (1 - u - v) * of_corner(0) + u * of_corner(1) + v * of_corner(2);
}

Vec2 uv_at(const DrawItem& item, int element, float u, float v) {
    return interpolated(item.mesh().UV, item.mesh().F, element, u, v);
}

}  // namespace

float coverage_at(const DrawItem& item, int element, float u, float v) {
    const Material& m = item.material;
    float opacity = m.opacity;
    if (item.alpha != AlphaMode::opaque) {
        opacity *= vertex_color(item, element, u, v).w();
        if (is_face(item) && item.textured()) {
            const Vec2 uv = uv_at(item, element, u, v);
            if (m.base_color_texture) opacity *= Texel(m.base_color_texture, uv).alpha();
            if (m.opacity_texture) opacity *= Texel(m.opacity_texture, uv).channel(m.opacity_texture.channel);
        }
    }
    if (item.alpha == AlphaMode::mask) opacity = opacity < m.alpha_cutoff ? 0.0f : 1.0f;
    if (item.alpha == AlphaMode::opaque) opacity = 1;
    return opacity;
}

Passage passage_at(const DrawItem& item, int element, float u, float v) {
    Passage passage;
    passage.coverage = coverage_at(item, element, u, v);
    const Material& m = item.material;
    if (item.kind != SurfaceKind::lit || !m.transmits()) return passage;
    Vec3 color = m.base_color.cwiseProduct(vertex_color(item, element, u, v).head<3>());
    float through = m.transmission, metallic = m.metallic;
    passage.roughness = transmitted_roughness(m.roughness, m.ior);
    passage.thickness = m.thickness * float(item.scale());
    passage.f90 = m.specular;
    Vec3 tinted = m.specular_color * m.dielectric_f0(Material::default_f0);
    if (is_face(item) && item.textured()) {
        const Vec2 uv = uv_at(item, element, u, v);
        const auto channel = [&](const Texture& texture) {
            return texture ? Texel(texture, uv).channel(texture.channel) : 1.0f;
        };
        if (m.base_color_texture) color = color.cwiseProduct(Texel(m.base_color_texture, uv).color());
        through *= channel(m.transmission_texture);
        metallic *= channel(m.metallic_texture);
        passage.thickness *= channel(m.thickness_texture);
        passage.roughness *= channel(m.roughness_texture);
        passage.f90 *= channel(m.specular_texture);
        if (m.specular_color_texture)
            tinted = tinted.cwiseProduct(Texel(m.specular_color_texture, uv).color());
    }
    passage.f0 = std::min(tinted.maxCoeff(), 1.0f) * passage.f90;
    passage.tint = color.cwiseMin(1.0f).cwiseMax(0.0f) * std::clamp(through * (1 - metallic), 0.0f, 1.0f);
    return passage;
}

float opacity_at(const DrawItem& item, int element, float u, float v, float cosine, bool is_open) {
    const Passage passage = passage_at(item, element, u, v);
    const Vec3 way = absorption_of(item.material) * ((is_open ? 1.0f : 0.5f) * passage.thickness),
               color = is_open ? passage.tint : passage.color();
    return passage.coverage * (1 - passage.entering(cosine) * (color.array() * (-way).array().exp()).mean());
}

RaySurface surface_at(const RayHit& hit, float dielectric_f0, float exposure) {
    const DrawItem& item = *hit.item;
    const MeshData& mesh = item.mesh();
    const Material& m = item.material;
    RaySurface s;
    s.normal = hit.normal;
    Vec3 base = m.base_color.cwiseProduct(vertex_color(item, hit.element, hit.u, hit.v).head<3>());
    float metallic = m.metallic, transmission = m.transmission;
    s.roughness = m.roughness;
    s.emission = m.emissive;
    const bool face = is_face(item);
    if (face && !mesh.N.empty()) {
        const Mat3 normal_matrix = item.object->T_world_mesh.linear().inverse().transpose().cast<float>();
        const Vec3 n = (normal_matrix * interpolated(mesh.N, mesh.F, hit.element, hit.u, hit.v)).normalized();
        if (n.allFinite()) s.normal = n.dot(hit.normal) < 0 ? Vec3(-n) : n;
    }
    if (face && item.textured()) {
        const Vec2 uv = uv_at(item, hit.element, hit.u, hit.v);
        if (m.base_color_texture) base = base.cwiseProduct(Texel(m.base_color_texture, uv).color());
        if (m.metallic_texture) metallic *= Texel(m.metallic_texture, uv).channel(m.metallic_texture.channel);
        if (m.transmission_texture)
            transmission *= Texel(m.transmission_texture, uv).channel(m.transmission_texture.channel);
        if (m.roughness_texture)
            s.roughness *= Texel(m.roughness_texture, uv).channel(m.roughness_texture.channel);
        if (m.emissive_texture) s.emission = s.emission.cwiseProduct(Texel(m.emissive_texture, uv).color());
    }
    if (item.kind != SurfaceKind::lit) {
        s.emission = base * shown_as_one(exposure);
        return s;
    }
    if (m.unlit) {
        s.emission = base;
        return s;
    }
    const float f0 = std::min(m.dielectric_f0(dielectric_f0) * m.specular, 1.0f);
    s.f0 = (1 - metallic) * f0 * m.specular_color + metallic * base;
    s.diffuse = (1 - metallic) * (1 - transmission) * base;
    return s;
}

}  // namespace easypbr::render
