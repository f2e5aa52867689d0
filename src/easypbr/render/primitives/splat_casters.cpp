#include "easypbr/render/primitives/splat_casters.h"

#include <algorithm>
#include <cmath>

namespace easypbr::render {

Vec4 light_in_mesh(const ShadowView& view, const DrawItem& item) {
    const Eigen::Affine3d inverse = item.object->T_world_mesh.inverse();
    const Vec3d v = view.perspective ? Vec3d(inverse * view.position)
                                     : Vec3d(inverse.linear() * -view.R_light_world.row(2).transpose());
    return {float(v.x()), float(v.y()), float(v.z()), view.perspective ? 1.0f : 0.0f};
}

float absorbed_by(float opacity) {
    return -std::log(std::clamp(1 - opacity, 1.125e-7f, 1.0f));
}

std::vector<std::string> caster_defines(const DrawItem& item) {
    std::vector<std::string> defines;
    if (item.alpha == AlphaMode::mask) defines.emplace_back("ALPHA_MASK");
    if (item.casts_tint()) defines.emplace_back("TINT");
    if (item.alpha != AlphaMode::opaque && item.with_colors) defines.emplace_back("VERTEX_COLOR");
    return defines;
}

void set_caster_alpha(const gl::Program& program, const DrawItem& item) {
    program.set("u_opacity", item.material.opacity);
    program.set("u_alpha_cutoff", item.material.alpha_cutoff);
}

}  // namespace easypbr::render
