#include "easypbr/render/primitives/splats/splat_driver.h"

#include <algorithm>
#include <array>
#include <limits>

#include "easypbr/gl/context.h"
#include "easypbr/render/primitives/splats/splat_projection.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

constexpr uint32_t group = 256;            ///< threads, as in shaders/splat_project.comp
constexpr size_t screen_splat_bytes = 64;  ///< ScreenSplat of shaders/common_splat.glsl
constexpr int buffers_of_vertices = 2;     ///< of shaders/overlay_gaussians.vert
constexpr std::array<uint32_t, 4> no_quads{4, 0, 0, 0};

/// Of the buffers, as shaders/splat_project.comp has them.
enum Slot {
    splats_slot,
    order_slot,
    means_slot,
    shapes_slot,
    harmonics_slot,
    depths_slot,
    quads_slot,
    sides_slot
};

uint64_t count_of(const std::vector<const DrawItem*>& items) {
    uint64_t count = 0;
    for (const DrawItem* item : items) count += uint64_t(item->mesh().V.rows());
    return count;
}

}  // namespace

bool SplatDriver::has_room(const std::vector<const DrawItem*>& items) {
    if (!has_memory_) return false;
    if (!limits_) limits_ = gl::storage_limits();
    size_t largest = size_t(count_of(items)) * screen_splat_bytes;
    for (const DrawItem* item : items)
        largest = std::max(largest, gpu::largest_splat_buffer(item->mesh(), item->with_colors));
    return limits_->of_vertices >= buffers_of_vertices && largest <= limits_->bytes &&
           count_of(items) / group < limits_->groups;
}

bool SplatDriver::begin(const Frame& frame, const std::vector<const DrawItem*>& items, SplatLight& light) {
    if (!has_room(items)) return false;
    const auto count = uint32_t(count_of(items));
    try {
        if (count > room_) {
            room_ = 0;
            splats_ = gl::Buffer(count * screen_splat_bytes);
            depths_ = gl::Buffer(count * sizeof(uint32_t));
            order_ = gl::Buffer(count * sizeof(uint32_t));
            room_ = count;
        }
        if (!quads_) quads_ = gl::Buffer(sizeof no_quads);
        quads_.update(0, gl::bytes_of(no_quads));
        uint32_t first = 0;
        for (const DrawItem* item : items) {
            project(frame, *item, first, light);
            first += uint32_t(item->mesh().V.rows());
        }
        sort_.run(depths_, order_, count);
    } catch (const gl::ContextLost&) {
        throw;
    } catch (const ContextError&) {
        // Its memory is smaller than the machine's.
        has_memory_ = false;
        drop();
        return false;
    }
    pictures_without_ = -1;
    return true;
}

void SplatDriver::drop() {
    buffers_ = {};
    sides_ = {};
    for (gl::Buffer* buffer : {&splats_, &depths_, &order_}) *buffer = {};
    room_ = 0;
    sort_ = {};
    blended_ = {};
    blending_ = {};
}

void SplatDriver::evict_unused() {
    if (pictures_without_ == most_pictures_without) return;
    if (++pictures_without_ == most_pictures_without) drop();
    if (pictures_without_ > 0) return;
    buffers_.evict_unused();
    sides_.evict_unused();
}

const gl::Buffer* SplatDriver::sides_of(const DrawItem& item, SplatLight& light) {
    const std::shared_ptr<SplatLight::Parts> parts = light.parts_of(item, false);
    if (!parts) return nullptr;
    return &sides_.get(parts, [&] { return gl::Buffer(parts->all_sides(*light.light(), item)); });
}

void SplatDriver::project(const Frame& frame, const DrawItem& item, uint32_t first, SplatLight& light) {
    const gpu::SplatBuffers& buffers = buffers_.get(item.mesh(), item.with_colors);
    if (buffers.count == 0) return;
    const SplatView view = view_of(frame);
    std::vector<std::string> defines;
    if (view.orthographic) defines.emplace_back("ORTHOGRAPHIC");
    if (item.style.splat_antialias) defines.emplace_back("ANTIALIAS");
    const gl::Buffer* sides = sides_of(item, light);
    if (sides) defines.emplace_back("DARKENED");
    gl::Program& program = projections_[defines];
    if (!program) program = gl::Program::compute("splat_project.comp", defines);
    const Vec3d centre = buffers.centre.cast<double>();
    Mat4d view_from_mesh = view.view_from_world * item.object->T_world_mesh.matrix();
    const Mat3d inverse = view_from_mesh.topLeftCorner<3, 3>().inverse();
    const Vec3d eye = view.orthographic ? Vec3d(inverse * Vec3d(0, 0, -1))
                                        : Vec3d(-inverse * view_from_mesh.topRightCorner<3, 1>() - centre);
    view_from_mesh.topRightCorner<3, 1>() += view_from_mesh.topLeftCorner<3, 3>() * centre;
    program.use();
    program.set("u_count", buffers.count);
    program.set("u_first", first);
    program.set("u_centre", buffers.centre);
    program.set("u_view", Mat4(view_from_mesh.cast<float>()));
    program.set("u_clip", Mat4(view.clip_from_view.cast<float>()));
    program.set("u_eye", Vec3(eye.cast<float>()));
    program.set("u_picture", Vec4(float(view.size.x()), float(view.size.y()), float(view.picture_size.x()),
                                  float(view.picture_size.y())));
    program.set("u_origin", Vec2(view.origin.cast<float>()));
    program.set("u_least_width", view.orthographic ? 0.5f : float(view.near));
    const Mat3d normal_from_mesh = item.object->T_world_mesh.linear().inverse().transpose();
    program.set("u_normal_from_mesh", Mat3(normal_from_mesh.cast<float>()));
    program.set("u_degree", uint32_t(buffers.degree));
    buffers.means.bind_storage(means_slot);
    buffers.shapes.bind_storage(shapes_slot);
    buffers.harmonics.bind_storage(harmonics_slot);
    splats_.bind_storage(splats_slot);
    depths_.bind_storage(depths_slot);
    order_.bind_storage(order_slot);
    quads_.bind_storage(quads_slot);
    if (sides) sides->bind_storage(sides_slot);
    gl::dispatch((buffers.count + group - 1) / group);
}

void SplatDriver::blend(const Frame& frame, const GBuffer& targets, const Target* opaque) {
    const Vec2i size = frame.size;
    if (!blended_ || Vec2i(blended_.width(), blended_.height()) != size) {
        blended_ = gl::Texture(gl::Format::rgba32f, size.x(), size.y());
        blending_ = gl::Framebuffer({&blended_});
    }
    blending_.bind();
    blending_.clear_color(0, {0, 0, 0, 0});
    std::vector<std::string> defines;
    if (frame.resolved->settings.splats.soft) defines.emplace_back("SOFT");
    if (opaque) defines.emplace_back("LIMITED");
    const gl::Program& rectangles = rectangles_.get(defines);
    rectangles.use();
    rectangles.set("u_size", Vec2(size.cast<float>()));
    rectangles.set("u_depth_target", 0);
    if (opaque) opaque->bind(0);
    splats_.bind_storage(splats_slot);
    order_.bind_storage(order_slot);
    gl::draw_quads({.blending = gl::over}, quads_);
    targets.display().bind();
    const gl::Program& over = over_.get({"ENCODED"});
    over.use();
    over.set("u_splats", 0);
    blended_.bind(0);
    gl::draw_screen({.blending = gl::over});
}

}  // namespace easypbr::render
