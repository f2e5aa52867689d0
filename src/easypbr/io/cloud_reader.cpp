#include "easypbr/io/cloud_reader.h"

#include <fmt/format.h>

#include "easypbr/scene/offset.h"

namespace easypbr::io {
namespace {

/// Elements, their columns and the arrays that they fill.
struct Cloud {
    Cloud(const Source& source, const std::vector<Element>& elements) {
        if (elements.empty() || elements[0].count == 0) fail(source, "no points");
        for (const Element& element : elements)
            plans.push_back({&element, std::vector<Column>(element.properties.size())});
        std::vector<VertexField> fields;
        std::vector<PropertyPlace> places;
        for (size_t e = 0; e < elements.size(); ++e)
            for (size_t i = 0; i < elements[e].properties.size(); ++i) {
                fields.push_back({elements[e].properties[i], &plans[e].columns[i]});
                places.push_back({e, i});
            }
        arrays.emplace(fields, elements[0].count);
        if (!arrays->position()) fail(source, "no positions: fields x, y, z expected");
        for (size_t axis = 0; axis < 3; ++axis) position[axis] = places[(*arrays->position())[axis]];
    }

    MeshData mesh() {
        MeshData result;
        arrays->normalize_real_colors();
        arrays->move_into(result);
        return result;
    }

    std::vector<ElementPlan> plans;
    std::optional<VertexArrays> arrays;
    std::array<PropertyPlace, 3> position;
};

/// Nothing is allocated for rows that cannot be there.
void check_size(const Source& source, const char* body, const std::vector<Element>& elements) {
    size_t left = size_t(source.end() - body);
    for (const Element& element : elements) {
        const size_t row = smallest_row(element);
        if (row && element.count > left / row)
            fail(source, fmt::format("truncated: {} points take {} bytes each, but {} bytes are left",
                                     element.count, row, left));
        left -= element.count * row;
    }
}

}  // namespace

MeshData read_binary_cloud(const Source& source, const char* body, std::endian endian,
                           const std::vector<Element>& elements) {
    check_size(source, body, elements);
    Cloud cloud(source, elements);
    cloud.arrays->recentre(sample_binary_rows(source, body, endian, elements, cloud.position));
    read_binary_elements(source, body, endian, cloud.plans);
    return cloud.mesh();
}

MeshData read_text_cloud(const Source& source, const TextRows& rows, const Element& element, TextBits* bits) {
    if (element.count > rows.count())
        fail_at_line(source, source.end(),
                     fmt::format("truncated: {} points expected, but the file ends after {}", element.count,
                                 rows.count()));
    const std::vector<Element> elements{element};
    Cloud cloud(source, elements);
    cloud.arrays->recentre(sample_text_rows(rows, elements, cloud.position));
    if (bits && bits->property) {
        bits->bits.resize(element.count);
        cloud.plans[0].columns[*bits->property].bits = bits->bits.data();
    }
    read_text_elements(source, rows, cloud.plans);
    return cloud.mesh();
}

}  // namespace easypbr::io
