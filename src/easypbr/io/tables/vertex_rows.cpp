#include "easypbr/io/tables/vertex_rows.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>
#include <set>
#include <string_view>

#include "easypbr/core/markup.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/tables/vertex_arrays.h"
#include "easypbr/scene/color_range.h"

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

RowPart color_part(const ArrayXf& C, bool has_types) {
    std::vector<std::string> names{"red", "green", "blue"};
    if (C.cols() == 4) names.emplace_back("alpha");
    // Among numbers without types a largest of 1 is full intensity.
    if (!has_types && color_code(range_of_colors(C).high) == 1)
        return {std::move(names), ScalarType::float32, [C](Eigen::Index row, char* out) {
                    for (Eigen::Index k = 0; k < C.cols(); ++k, out += sizeof(float)) {
                        const float value = float(color_code(C(row, k))) / 255;
                        std::memcpy(out, &value, sizeof value);
                    }
                }};
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
    const std::vector<std::string> names = scalar_field_names(mesh);
    for (size_t i = 0; i < names.size(); ++i)
        if (is_of(mesh.scalars[i].values))
            parts.push_back(raw_part({names[i]}, ScalarType::float32, mesh.scalars[i].values));
}

/// UTF-8 without what ends a name, a line or a number's unit in one of the formats.
std::string plain_name(const std::string& given) {
    constexpr std::string_view separators = ",;\"'#/\\()[]";
    std::string name = valid_utf8(given);
    for (char& c : name) {
        const auto code = static_cast<unsigned char>(c);
        if (code <= ' ' || code == 127 || separators.find(c) != std::string_view::npos) c = '_';
    }
    return name;
}

/// The same, none twice.
std::vector<std::string> plain_names(const MeshData& mesh) {
    std::vector<std::string> names;
    std::set<std::string> taken;
    for (const ScalarArray& scalar : mesh.scalars) taken.insert(scalar.name);
    for (const ScalarArray& scalar : mesh.scalars) {
        const std::string plain = plain_name(scalar.name);
        std::string name = plain;
        for (int number = 2; name != scalar.name && !taken.insert(name).second; ++number)
            name = fmt::format("{}_{}", plain, number);
        names.push_back(std::move(name));
    }
    return names;
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

std::vector<std::string> scalar_field_names(const MeshData& mesh) {
    std::vector<std::string> names = plain_names(mesh);
    for (std::string& name : names) name = scalar_field_name(name);
    return names;
}

std::vector<std::string> renamed_scalars(const MeshData& mesh) {
    const std::vector<std::string> names = plain_names(mesh);
    std::vector<std::string> renamed;
    for (size_t i = 0; i < names.size(); ++i)
        if (names[i] != mesh.scalars[i].name)
            renamed.push_back(fmt::format("'{}' as '{}'", mesh.scalars[i].name, names[i]));
    return renamed;
}

std::vector<RowPart> vertex_row_parts(const MeshData& mesh, const RowStyle& style) {
    std::vector<RowPart> parts{position_part(mesh)};
    const auto add = [&](auto&& names, ScalarType type, const auto& array) {
        if (!array.empty()) parts.push_back(raw_part(names, type, array));
    };
    using Names = std::vector<std::string>;
    add(style.normal_names, ScalarType::float32, mesh.N);
    if (!mesh.C.empty())
        parts.push_back(style.packed_colors ? packed_color_part(mesh.C)
                                            : color_part(mesh.C, style.has_types));
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
