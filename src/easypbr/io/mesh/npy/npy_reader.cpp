#include <fmt/format.h>
#include <fmt/ranges.h>

#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/mesh/npy/npy_points.h"

namespace easypbr::io {
namespace {

constexpr size_t most_npy_columns = 1000;

/// Names for the columns of a plain array of positions and what stands behind them.
std::vector<std::string> point_columns(const Source& source, const NpyArray& array) {
    if (array.shape.size() < 2 || array.columns() < 3 || array.columns() > most_npy_columns)
        fail(source, fmt::format("an array of shape n x 3 or with more columns, or a structured one, "
                                 "expected; got {}",
                                 array.shape_text()));
    const std::vector<Element> elements = array.elements(std::vector<std::string>(array.columns(), "_"));
    std::vector<PropertyPlace> places;
    for (size_t e = 0; e < elements.size(); ++e)
        for (size_t i = 0; i < elements[e].properties.size(); ++i) places.push_back({e, i});
    const auto samples = sample_binary_rows(source, array.data, array.endian, elements, places);
    return guess_columns(samples, false);
}

}  // namespace

BinaryTable point_table(const Source& source, const NpyArray& array) {
    return {
        source, array.data, array.endian,
        array.elements(array.is_structured() ? std::vector<std::string>() : point_columns(source, array))};
}

MeshData read_npy(const Source& source) {
    if (source.bytes.empty()) fail(source, "the file is empty");
    MeshData mesh = read_binary_cloud(source, {point_table(source, parse_npy(source, source.bytes))});
    drop_points_without_position(source, mesh);
    return mesh;
}

}  // namespace easypbr::io
