#include "easypbr/io/tables/vertex_rows.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>

#include "easypbr/core/parallel.h"
#include "easypbr/io/tables/vertex_arrays.h"

namespace easypbr::io {
namespace {

static_assert(std::endian::native == std::endian::little, "the writers copy values as they are in memory");

constexpr size_t row_grain = 1 << 14;

/// The arrays are held: they are shared, not copied.
template <class A>
RowPart raw_part(std::vector<std::string> names, ScalarType type, const A& array) {
    const size_t size = names.size() * size_of(type);
    return {std::move(names), type, [array, size](Eigen::Index row, char* out) {
                std::memcpy(out, array.data() + row * array.cols(), size);
            }};
}

RowPart position_part(const MeshData& mesh) {
    if (mesh.offset.isZero(0)) return raw_part({"x", "y", "z"}, ScalarType::float32, mesh.V);
    return {{"x", "y", "z"}, ScalarType::float64, [V = mesh.V, o = mesh.offset](Eigen::Index row, char* out) {
                const Vec3d position = V.row(row).transpose().cast<double>() + o;
                std::memcpy(out, position.data(), sizeof position);
            }};
}

uint8_t color_code(float value) {
    return uint8_t(std::lround(std::clamp(value, 0.0f, 1.0f) * 255));
}

RowPart color_part(const ArrayXf& C) {
    std::vector<std::string> names{"red", "green", "blue"};
    if (C.cols() == 4) names.emplace_back("alpha");
    return {std::move(names), ScalarType::uint8, [C](Eigen::Index row, char* out) {
                for (Eigen::Index k = 0; k < C.cols(); ++k) out[k] = char(color_code(C(row, k)));
            }};
}

/// From the lowest byte on: blue, green, red, alpha. Those who read "rgb" expect it to be a float.
RowPart packed_color_part(const ArrayXf& C) {
    const bool alpha = C.cols() == 4;
    return {{alpha ? "rgba" : "rgb"},
            alpha ? ScalarType::uint32 : ScalarType::float32,
            [C, alpha](Eigen::Index row, char* out) {
                for (Eigen::Index k = 0; k < 3; ++k) out[k] = char(color_code(C(row, 2 - k)));
                out[3] = alpha ? char(color_code(C(row, 3))) : 0;
            }};
}

void add_labels_and_scalars(const MeshData& mesh, PerElement element, std::vector<RowPart>& parts) {
    const auto is_of = [&](const auto& array) {
        return !array.empty() && element_of(mesh, array.rows()) == element;
    };
    if (is_of(mesh.L)) parts.push_back(raw_part({"label"}, ScalarType::int32, mesh.L));
    for (const ScalarArray& scalar : mesh.scalars)
        if (is_of(scalar.values))
            parts.push_back(
                raw_part({scalar_field_name(plain_name(scalar.name))}, ScalarType::float32, scalar.values));
}

template <class Number>
void append_number(const char* at, std::string& out) {
    Number value;
    std::memcpy(&value, at, sizeof value);
    if constexpr (sizeof(Number) == 1)
        fmt::format_to(std::back_inserter(out), "{}", int(value));
    else
        fmt::format_to(std::back_inserter(out), "{}", value);
}

void append_number(ScalarType type, const char* at, std::string& out) {
    switch (type) {
        case ScalarType::uint8:
            return append_number<uint8_t>(at, out);
        case ScalarType::int32:
            return append_number<int32_t>(at, out);
        case ScalarType::float64:
            return append_number<double>(at, out);
        default:
            return append_number<float>(at, out);
    }
}

}  // namespace

std::string plain_name(std::string name) {
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-') c = '_';
    return name;
}

std::vector<RowPart> vertex_row_parts(const MeshData& mesh, const RowStyle& style) {
    std::vector<RowPart> parts{position_part(mesh)};
    const auto add = [&](auto&& names, ScalarType type, const auto& array) {
        if (!array.empty()) parts.push_back(raw_part(names, type, array));
    };
    using Names = std::vector<std::string>;
    add(style.normal_names, ScalarType::float32, mesh.N);
    if (!mesh.C.empty())
        parts.push_back(style.packed_colors ? packed_color_part(mesh.C) : color_part(mesh.C));
    add(style.uv_names, ScalarType::float32, mesh.UV);
    add(Names{"tx", "ty", "tz"}, ScalarType::float32, mesh.T);
    add(Names{"bitangent_length"}, ScalarType::float32, mesh.B);
    add(Names{"intensity"}, ScalarType::float32, mesh.I);
    add_labels_and_scalars(mesh, PerElement::vertex, parts);
    return parts;
}

std::vector<RowPart> face_row_parts(const MeshData& mesh) {
    std::vector<RowPart> parts;
    add_labels_and_scalars(mesh, PerElement::face, parts);
    return parts;
}

void append_rows(const std::vector<RowPart>& parts, size_t count, std::string& out) {
    size_t stride = 0;
    for (const RowPart& part : parts) stride += part.size;
    const size_t begin = out.size();
    out.resize(begin + count * stride);
    parallel_for(count, row_grain, [&](size_t row) {
        char* target = out.data() + begin + row * stride;
        for (const RowPart& part : parts) {
            part.write(Eigen::Index(row), target);
            target += part.size;
        }
    });
}

void append_text_rows(const std::vector<RowPart>& parts, size_t count, char delimiter, std::string& out) {
    std::vector<std::string> chunks((count + row_grain - 1) / row_grain);
    parallel_chunks(count, row_grain, [&](size_t begin, size_t end) {
        std::string& text = chunks[begin / row_grain];
        std::array<char, 64> values;
        for (size_t row = begin; row < end; ++row) {
            for (const RowPart& part : parts) {
                part.write(Eigen::Index(row), values.data());
                for (size_t k = 0; k < part.names.size(); ++k) {
                    append_number(part.type, values.data() + k * size_of(part.type), text);
                    text += delimiter;
                }
            }
            text.back() = '\n';
        }
    });
    for (const std::string& chunk : chunks) out += chunk;
}

}  // namespace easypbr::io
