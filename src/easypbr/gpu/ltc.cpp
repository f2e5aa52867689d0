#include "easypbr/gpu/ltc.h"

namespace easypbr::gpu {
namespace {

#include "easypbr_ltc.inc"

static_assert(sizeof ltc_inverse == sizeof(float) * 4 * ltc_size * ltc_size);

}  // namespace

std::span<const float> ltc_table() {
    return ltc_inverse;
}

native::View host_ltc() {
    return {.data = std::as_bytes(ltc_table()).data(),
            .width = ltc_size,
            .height = ltc_size,
            .held_width = ltc_size,
            .held_height = ltc_size};
}

}  // namespace easypbr::gpu
