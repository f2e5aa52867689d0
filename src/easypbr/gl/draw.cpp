#include "easypbr/gl/draw.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>

#include "easypbr/core/interrupt.h"
#include "easypbr/gl/context.h"
#include "easypbr/gl/pace.h"

namespace easypbr::gl {
namespace {

void enable(GLenum capability, bool on) {
    on ? glEnable(capability) : glDisable(capability);
}

GLenum function_of(DepthTest test) {
    constexpr GLenum functions[] = {GL_ALWAYS, GL_ALWAYS, GL_LESS,   GL_LEQUAL,
                                    GL_EQUAL,  GL_GEQUAL, GL_GREATER};
    return functions[size_t(test)];
}

GLenum factor_of(Factor factor) {
    constexpr GLenum factors[] = {GL_ZERO,
                                  GL_ONE,
                                  GL_SRC_COLOR,
                                  GL_ONE_MINUS_SRC_ALPHA,
                                  GL_ONE_MINUS_DST_ALPHA,
                                  GL_SRC1_COLOR,
                                  GL_ONE_MINUS_SRC1_ALPHA,
                                  GL_CONSTANT_COLOR,
                                  GL_ONE_MINUS_CONSTANT_COLOR};
    return factors[size_t(factor)];
}

GLenum equation_of(BlendEquation equation) {
    return equation == BlendEquation::add ? GL_FUNC_ADD : GL_MAX;
}

void apply(const Blending& b) {
    enable(GL_BLEND, b != replace);
    // A second source is an error where there are several targets, even with blending off: always set.
    glBlendFuncSeparate(factor_of(b.source), factor_of(b.target), factor_of(b.source_alpha),
                        factor_of(b.target_alpha));
    glBlendEquationSeparate(equation_of(b.color_equation), equation_of(b.alpha_equation));
    glBlendColor(b.constant, b.constant, b.constant, b.constant);
}

void apply(const DrawState& state) {
    enable(GL_DEPTH_TEST, state.depth_test != DepthTest::off);
    glDepthFunc(function_of(state.depth_test));
    glDepthMask(state.write_depth);
    glDepthRangef(state.least_depth, 1);
    const auto write = GLboolean(state.write_color);
    glColorMask(write, write, write, write);
    apply(state.blending);
    enable(GL_SCISSOR_TEST, state.scissor.has_value());
    if (state.scissor)
        glScissor(state.scissor->x, state.scissor->y, state.scissor->width, state.scissor->height);
    enable(GL_CULL_FACE, state.culling != Culling::none);
    if (state.culling != Culling::none) glCullFace(state.culling == Culling::front ? GL_FRONT : GL_BACK);
    glFrontFace(state.clockwise_fronts ? GL_CW : GL_CCW);
}

/// A driver that draws on the CPU takes about a third of a second for as much.
constexpr int64_t most_pixels = 1 << 22;
constexpr int most_indices = 3 << 19;

/// Whether what is large has to be drawn piece by piece, so that it can be interrupted between the pieces.
bool draws_in_pieces() {
    return can_be_interrupted() && Context::current().info().software;
}

bool is_large_viewport() {
    std::array<GLint, 4> viewport{};
    glGetIntegerv(GL_VIEWPORT, viewport.data());
    return int64_t(viewport[2]) * viewport[3] > most_pixels;
}

/// Rows of pixels without gaps, as all of this library's arrays are: other values would read and write past
/// their ends.
void reset_pixel_store() {
    for (const GLenum target : {GL_PIXEL_PACK_BUFFER, GL_PIXEL_UNPACK_BUFFER}) glBindBuffer(target, 0);
    for (const GLenum parameter : {GL_PACK_ALIGNMENT, GL_UNPACK_ALIGNMENT}) glPixelStorei(parameter, 1);
    for (const GLenum parameter :
         {GL_PACK_SWAP_BYTES, GL_PACK_LSB_FIRST, GL_PACK_ROW_LENGTH, GL_PACK_IMAGE_HEIGHT, GL_PACK_SKIP_ROWS,
          GL_PACK_SKIP_PIXELS, GL_PACK_SKIP_IMAGES, GL_UNPACK_SWAP_BYTES, GL_UNPACK_LSB_FIRST,
          GL_UNPACK_ROW_LENGTH, GL_UNPACK_IMAGE_HEIGHT, GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_PIXELS,
          GL_UNPACK_SKIP_IMAGES})
        glPixelStorei(parameter, 0);
}

/// One of these may be open at a time: the renderer's own could not begin.
void end_queries() {
    for (const GLenum target :
         {GL_SAMPLES_PASSED, GL_ANY_SAMPLES_PASSED, GL_ANY_SAMPLES_PASSED_CONSERVATIVE}) {
        GLint open = 0;
        glGetQueryiv(target, GL_CURRENT_QUERY, &open);
        if (open != 0) glEndQuery(target);
    }
}

}  // namespace

void draw_screen(const DrawState& state) {
    apply(state);
    Context::current().no_attributes().bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    if (draws_in_pieces() && is_large_viewport()) wait_for_driver();
}

void draw_points(const DrawState& state, const VertexArray& array, int count) {
    apply(state);
    array.bind();
    glEnable(GL_PROGRAM_POINT_SIZE);
    glDrawArrays(GL_POINTS, 0, count);
    glDisable(GL_PROGRAM_POINT_SIZE);
}

void draw_quads(const DrawState& state, const VertexArray& array, int instances) {
    apply(state);
    array.bind();
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, instances);
}

void draw_quads(const DrawState& state, const Buffer& counts) {
    apply(state);
    Context::current().no_attributes().bind();
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, counts.id());
    glDrawArraysIndirect(GL_TRIANGLE_STRIP, nullptr);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
}

void dispatch(uint32_t groups) {
    glDispatchCompute(groups, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

StorageLimits storage_limits() {
    GLint64 bytes = 0;
    GLint groups = 0, of_vertices = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &bytes);
    glGetIntegeri_v(GL_MAX_COMPUTE_WORK_GROUP_COUNT, 0, &groups);
    glGetIntegerv(GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS, &of_vertices);
    return {size_t(std::max<GLint64>(0, bytes)), uint32_t(std::max(0, groups)), of_vertices};
}

void draw_triangles(const DrawState& state, const VertexArray& array, int64_t first_index, int index_count) {
    apply(state);
    array.bind();
    const int piece = index_count > most_indices && draws_in_pieces() ? most_indices : index_count;
    for (int drawn = 0; drawn < index_count; drawn += piece) {
        const size_t first = (size_t(first_index) + size_t(drawn)) * sizeof(uint32_t);
        glDrawElements(GL_TRIANGLES, std::min(piece, index_count - drawn), GL_UNSIGNED_INT,
                       reinterpret_cast<const void*>(first));
        if (piece < index_count) wait_for_driver();
    }
}

void reset_state() {
    if (!Context::has_driver()) return;
    end_queries();
    for (const GLenum off :
         {GL_STENCIL_TEST, GL_POLYGON_OFFSET_FILL, GL_RASTERIZER_DISCARD, GL_SAMPLE_COVERAGE,
          GL_FRAMEBUFFER_SRGB, GL_COLOR_LOGIC_OP, GL_PRIMITIVE_RESTART, GL_DEPTH_CLAMP})
        glDisable(off);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    // Row 0 of every target is the top of the picture; depth runs from 1 (near) to 0 (infinitely far).
    glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    reset_pixel_store();
    for (unsigned unit = 0; unit < 16; ++unit) glBindSampler(unit, 0);
}

bool has_driver() {
    return Context::has_driver();
}

void finish() {
    if (Context::has_driver()) glFinish();
}

void flush() {
    if (Context::has_driver()) glFlush();
}

}  // namespace easypbr::gl
