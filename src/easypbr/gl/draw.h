// Draws, each with all of its fixed-function state: nothing is left over from the draw before.
#pragma once

#include <cstdint>
#include <optional>

#include "easypbr/core/picture.h"
#include "easypbr/gl/buffer.h"

namespace easypbr::gl {

enum class DepthTest { off, always, less, less_equal, equal, greater_equal, greater };

enum class Factor {
    zero,
    one,
    source_color,
    one_minus_source_alpha,
    one_minus_target_alpha,
    source1_color,  ///< of the second output of dual-source blending
    one_minus_source1_alpha,
    constant,
    one_minus_constant
};

enum class BlendEquation { add, maximum };

/// source * Factor + target * Factor, or the larger of source and target. The alpha channel may differ.
struct Blending {
    Factor source = Factor::one, target = Factor::zero;
    Factor source_alpha = source, target_alpha = target;
    BlendEquation color_equation = BlendEquation::add, alpha_equation = color_equation;
    float constant = 0;  ///< Factor::constant, in all channels

    bool operator==(const Blending&) const = default;
};

inline constexpr Blending replace{};
inline constexpr Blending add{.source = Factor::one, .target = Factor::one};
/// Premultiplied colours over what is there.
inline constexpr Blending over{.source = Factor::one, .target = Factor::one_minus_source_alpha};
inline constexpr Blending maximum{.color_equation = BlendEquation::maximum};

enum class Culling { none, back, front };

/// Depth is reversed: 1 at the near plane, 0 infinitely far. Row 0 of a target is the top of the picture.
struct DrawState {
    DepthTest depth_test = DepthTest::off;
    bool write_depth = false;  ///< while there is a depth test
    bool write_color = true;
    float least_depth = 0;  ///< fragments' depths are mapped to [least_depth, 1]
    Blending blending = replace;
    std::optional<PixelRect> scissor = {};
    Culling culling = Culling::none;
    bool clockwise_fronts = false;  ///< front faces are clockwise in the window, for mirroring transforms
};

/// The program that is in use draws to the framebuffer that is bound, with the context current.
/// A triangle that covers the whole viewport, for shaders/screen_triangle.vert.
void draw_screen(const DrawState& state);
/// Points of the size that the vertex shader writes.
void draw_points(const DrawState& state, const VertexArray& array, int count);
/// A triangle strip of four vertices for each instance.
void draw_quads(const DrawState& state, const VertexArray& array, int instances);
/// As a buffer says that a compute shader has written: four uint32_t, 4, the number of instances, 0, 0.
/// Without attributes.
void draw_quads(const DrawState& state, const Buffer& counts);
/// Triangles of 32-bit indices.
void draw_triangles(const DrawState& state, const VertexArray& array, int64_t first_index, int index_count);

/// Runs the compute shader that is in use in so many groups; what comes later sees what it writes.
void dispatch(uint32_t groups);

/// What storage buffers may be in shaders.
struct StorageLimits {
    size_t bytes = 0;     ///< of a buffer
    uint32_t groups = 0;  ///< of a dispatch()
    int of_vertices = 0;  ///< buffers that a vertex shader reads
};
StorageLimits storage_limits();

/// Sets what DrawState does not hold to what the renderer expects, after code that may have left anything
/// behind.
void reset_state();

/// Whether there is a context whose driver is loaded.
bool has_driver();
/// Waits until the driver has done everything.
void finish();
/// Lets the driver begin with everything.
void flush();

}  // namespace easypbr::gl
