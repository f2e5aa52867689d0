// Component types of accessors as C++ types.
#pragma once

#include <cstddef>
#include <cstdint>

namespace easypbr::io {

/// Calls use(T{}) with the C++ type of a component type, 5120 to 5126; an unknown one stands for floats.
template <class Use>
void with_component(size_t type, Use&& use) {
    switch (type) {
        case 5120:
            return use(int8_t{});
        case 5121:
            return use(uint8_t{});
        case 5122:
            return use(int16_t{});
        case 5123:
            return use(uint16_t{});
        case 5125:
            return use(uint32_t{});
        default:
            return use(float{});
    }
}

}  // namespace easypbr::io
