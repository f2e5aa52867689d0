#include <algorithm>
#include <limits>

#include "easypbr/io/tables/element_table.h"
#include "easypbr/io/tables/value_copy.h"
#include "easypbr/scene/offset.h"

namespace easypbr::io {
namespace {

/// Where a property lies in the file: the value of row i at begin + i * stride. Null when lists stand before.
struct PropertyLayout {
    const char* begin = nullptr;
    size_t stride = 0, rows = 0;
};

PropertyLayout property_layout_of(const Source& source, const char* body,
                                  const std::vector<Element>& elements, PropertyPlace place) {
    const auto has_list = [](const Element& element) {
        return std::ranges::any_of(element.properties, [](const Property& p) { return bool(p.count_type); });
    };
    if (std::any_of(elements.begin(), elements.begin() + long(place.element) + 1, has_list)) return {};
    size_t left = size_t(source.end() - body);
    for (size_t i = 0; i < place.element; ++i) {
        const size_t stride = smallest_row(elements[i]);
        if (stride && elements[i].count > left / stride) return {};
        body += elements[i].count * stride;
        left -= elements[i].count * stride;
    }
    const Element& element = elements[place.element];
    PropertyLayout layout{body, smallest_row(element), 0};
    layout.rows = std::min(element.count, left / layout.stride);
    for (size_t i = 0; i < place.property; ++i) layout.begin += size_of(element.properties[i].type);
    return layout;
}

}  // namespace

std::vector<std::vector<double>> sample_binary_rows(const Source& source, const char* body,
                                                    std::endian endian, const std::vector<Element>& elements,
                                                    const std::vector<PropertyPlace>& places) {
    std::vector<PropertyLayout> layouts;
    size_t rows = std::numeric_limits<size_t>::max();
    for (const PropertyPlace& place : places) {
        layouts.push_back(property_layout_of(source, body, elements, place));
        rows = std::min(rows, layouts.back().rows);
    }
    std::vector<std::vector<double>> samples(std::min(rows, offset_sample_count),
                                             std::vector<double>(places.size()));
    for (size_t i = 0; i < samples.size(); ++i) {
        const size_t row = spread_row(i, samples.size(), rows);
        for (size_t k = 0; k < places.size(); ++k) {
            const Property& property = elements[places[k].element].properties[places[k].property];
            const ValueBlock block{
                layouts[k].begin + row * layouts[k].stride, 0, 1, 1, 1, property.scale, property.shift};
            copy_values(block, property.type, endian != std::endian::native, &samples[i][k]);
        }
    }
    return samples;
}

std::vector<Vec3d> sample_binary_positions(const Source& source, const char* body, std::endian endian,
                                           const std::vector<Element>& elements,
                                           const std::array<PropertyPlace, 3>& position) {
    std::vector<Vec3d> samples;
    for (const auto& row :
         sample_binary_rows(source, body, endian, elements, {position.begin(), position.end()}))
        samples.emplace_back(row[0], row[1], row[2]);
    return samples;
}

}  // namespace easypbr::io
