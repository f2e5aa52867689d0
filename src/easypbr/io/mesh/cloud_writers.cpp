#include "easypbr/io/mesh/cloud_writers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "easypbr/io/archive/zip_writer.h"
#include "easypbr/io/mesh/left_out.h"
#include "easypbr/io/tables/npy_builder.h"
#include "easypbr/io/tables/vertex_arrays.h"
#include "easypbr/io/tables/vertex_rows.h"

namespace easypbr::io {
namespace {

char pcd_type(ScalarType type) {
    if (!is_integer(type)) return 'F';
    return type == ScalarType::uint8 || type == ScalarType::uint32 ? 'U' : 'I';
}

std::string_view npy_type(ScalarType type) {
    switch (type) {
        case ScalarType::uint8:
            return "|u1";
        case ScalarType::int32:
            return "<i4";
        case ScalarType::float64:
            return "<f8";
        default:
            return "<f4";
    }
}

/// PCL reads labels as unsigned.
bool has_negative(const Array1i& L) {
    return !L.empty() && L.minCoeff() < 0;
}

}  // namespace

std::string encode_pcd(const MeshData& mesh) {
    const RowStyle style{
        .normal_names = {"normal_x", "normal_y", "normal_z"}, .uv_names = {"u", "v"}, .packed_colors = true};
    const std::vector<RowPart> parts = vertex_row_parts(mesh, style);
    std::vector<std::string> names, sizes, counts;
    std::vector<char> types;
    for (const RowPart& part : parts)
        for (const std::string& name : part.names) {
            const bool label = name == "label" && part.type == ScalarType::int32;
            names.push_back(name);
            sizes.push_back(fmt::format("{}", size_of(part.type)));
            types.push_back(label && !has_negative(mesh.L) ? 'U' : pcd_type(part.type));
            counts.emplace_back("1");
        }
    std::string out = fmt::format(
        "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS {}\nSIZE {}\nTYPE {}\nCOUNT {}\n"
        "WIDTH {}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA binary\n",
        fmt::join(names, " "), fmt::join(sizes, " "), fmt::join(types, " "), fmt::join(counts, " "),
        mesh.V.rows(), mesh.V.rows());
    append_rows(parts, size_t(mesh.V.rows()), out);
    return out;
}

std::string encode_xyz(const MeshData& mesh, char delimiter) {
    const std::vector<RowPart> parts = vertex_row_parts(mesh, {.has_types = false});
    std::string out = delimiter == ',' ? "" : "# ";
    for (const RowPart& part : parts)
        for (const std::string& name : part.names) out += name + delimiter;
    out.back() = '\n';
    append_text_rows(parts, size_t(mesh.V.rows()), delimiter, out);
    return out;
}

std::string encode_npy(const MeshData& mesh) {
    const std::vector<RowPart> parts = vertex_row_parts(mesh);
    std::string fields;
    for (const RowPart& part : parts)
        for (const std::string& name : part.names)
            fields += fmt::format("('{}', '{}'), ", name, npy_type(part.type));
    std::string out = npy_header("[" + fields + "]", fmt::format("({},)", mesh.V.rows()));
    append_rows(parts, size_t(mesh.V.rows()), out);
    return out;
}

std::string encode_npz(const MeshData& mesh) {
    ZipWriter archive;
    const auto add = [&](const std::string& name, std::string_view type, const auto& array) {
        if (array.size() == 0) return;
        const std::string shape = array.cols() == 1 ? fmt::format("({},)", array.rows())
                                                    : fmt::format("({}, {})", array.rows(), array.cols());
        std::string entry = npy_header(fmt::format("'{}'", type), shape);
        entry.append(reinterpret_cast<const char*>(array.data()),
                     size_t(array.size()) * sizeof(*array.data()));
        archive.add(name + ".npy", entry);
    };
    add("V", "<f4", mesh.V);
    add("N", "<f4", mesh.N);
    add("C", "<f4", mesh.C);
    add("UV", "<f4", mesh.UV);
    add("T", "<f4", mesh.T);
    add("B", "<f4", mesh.B);
    add("F", "<i4", mesh.F);
    add("E", "<i4", mesh.E);
    add("L", "<i4", mesh.L);
    add("I", "<f4", mesh.I);
    if (!mesh.offset.isZero(0)) add("offset", "<f8", mesh.offset);
    if (keeps_voxel_size(mesh, "npz"))
        add("voxel_size", "<f4", Array1f::Dense(Array1f::Dense::Constant(1, mesh.voxel_size)));
    const std::vector<std::string> names = scalar_field_names(mesh);
    for (size_t i = 0; i < names.size(); ++i) add(names[i], "<f4", mesh.scalars[i].values);
    return archive.finish();
}

}  // namespace easypbr::io
