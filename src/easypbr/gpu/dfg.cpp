#include "easypbr/gpu/dfg.h"

#include "easypbr/scene/settings.h"

namespace easypbr::gpu {
namespace {

#include "easypbr_dfg.inc"

constexpr size_t texels = size_t(dfg_size) * dfg_size;
static_assert(std::size(sheen_albedo) == texels && std::size(dfg_ue4) == 2 * texels);

native::View view_of(std::span<const uint16_t> table) {
    return {.data = std::as_bytes(table).data(),
            .width = dfg_size,
            .height = dfg_size,
            .held_width = dfg_size,
            .held_height = dfg_size};
}

}  // namespace

std::span<const uint16_t> dfg_table(Brdf brdf) {
    switch (brdf) {
        case Brdf::separable:
            return dfg_separable;
        case Brdf::ue4:
            return dfg_ue4;
        default:
            return dfg_height_correlated;
    }
}

native::View host_dfg(Brdf brdf) {
    return view_of(dfg_table(brdf));
}

std::span<const uint16_t> sheen_albedo_table() {
    return sheen_albedo;
}

native::View host_sheen_albedo() {
    return view_of(sheen_albedo_table());
}

}  // namespace easypbr::gpu
