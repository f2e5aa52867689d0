#include "easypbr/gpu/radix_sort.h"

#include "easypbr/gl/draw.h"

namespace easypbr::gpu {
namespace {

/// As in shaders/common_sort.glsl.
constexpr uint32_t block_keys = 2048, digits = 256, digit_bits = 8;
/// Of the buffers, as the shaders have them.
enum Slot { keys_slot, values_slot, sorted_keys_slot, sorted_values_slot, counts_slot, totals_slot };

void make_room(gl::Buffer& buffer, size_t values) {
    if (buffer.size() < values * sizeof(uint32_t)) buffer = gl::Buffer(values * sizeof(uint32_t));
}

}  // namespace

void RadixSort::run(const gl::Buffer& keys, const gl::Buffer& values, uint32_t count) {
    if (count == 0) return;
    if (!count_) {
        count_ = gl::Program::compute("sort_count.comp");
        sum_ = gl::Program::compute("sort_sum.comp");
        move_ = gl::Program::compute("sort_move.comp");
    }
    const uint32_t blocks = (count + block_keys - 1) / block_keys;
    make_room(other_keys_, count);
    make_room(other_values_, count);
    make_room(counts_, size_t(blocks) * digits);
    make_room(totals_, digits);
    counts_.bind_storage(counts_slot);
    totals_.bind_storage(totals_slot);
    const gl::Buffer *from_keys = &keys, *from_values = &values, *to_keys = &other_keys_,
                     *to_values = &other_values_;
    for (uint32_t shift = 0; shift < 32; shift += digit_bits) {
        from_keys->bind_storage(keys_slot);
        from_values->bind_storage(values_slot);
        to_keys->bind_storage(sorted_keys_slot);
        to_values->bind_storage(sorted_values_slot);
        const auto step = [&](const gl::Program& program, uint32_t groups) {
            program.use();
            program.set("u_sorted", count);
            program.set("u_shift", shift);
            program.set("u_blocks", blocks);
            gl::dispatch(groups);
        };
        step(count_, blocks);
        step(sum_, digits);
        step(move_, blocks);
        std::swap(from_keys, to_keys);
        std::swap(from_values, to_values);
    }
    // After an even number of digits the keys are where they were.
}

}  // namespace easypbr::gpu
