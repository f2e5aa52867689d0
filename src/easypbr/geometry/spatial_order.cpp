#include "easypbr/geometry/spatial_order.h"

#include <meshoptimizer.h>

namespace easypbr {

std::vector<int32_t> spatial_order(const Array3f& points) {
    const auto count = size_t(points.rows());
    std::vector<unsigned int> place(count);
    if (count) meshopt_spatialSortRemap(place.data(), points.data(), count, 3 * sizeof(float));
    std::vector<int32_t> order(count);
    for (size_t i = 0; i < count; ++i) order[place[i]] = int32_t(i);
    return order;
}

}  // namespace easypbr
