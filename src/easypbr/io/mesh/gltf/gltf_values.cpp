#include "easypbr/io/mesh/gltf/gltf_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "easypbr/core/error.h"
#include "easypbr/io/mesh/gltf/gltf_accessor.h"

namespace easypbr::io {
namespace {

constexpr int32_t most_exact = 1 << 24;  ///< whole numbers up to this one are floats
constexpr int most_value_columns = 4;

bool holds_labels(const MeshData& data) {
    return data.L.rows() == data.V.rows() && data.L.minCoeff() >= -most_exact &&
           data.L.maxCoeff() <= most_exact;
}

/// The format has no numbers that are not finite.
bool holds_scalar(const MeshData& data, const ScalarArray& scalar) {
    return scalar.values.rows() == data.V.rows() && scalar.values.allFinite();
}

bool are_labels(const ArrayXf::Dense& values) {
    return values.cols() == 1 && std::all_of(values.data(), values.data() + values.size(), [](float value) {
               return std::floor(value) == value && std::abs(value) <= float(most_exact);
           });
}

/// Whether the name, without any "_" before it, is that of the attribute of labels or of intensities.
bool is_name_of_own(std::string_view name) {
    const size_t begin = name.find_first_not_of('_');
    if (begin == std::string_view::npos) return false;
    const std::string attribute = fmt::format("_{}", name.substr(begin));
    return attribute == gltf_label_name || attribute == gltf_intensity_name;
}

/// Names with another meaning have a second "_".
std::string attribute_name(const std::string& scalar) {
    return (is_name_of_own(scalar) ? "__" : "_") + scalar;
}

std::string scalar_name_of(const std::string& attribute) {
    const std::string name = attribute.substr(1);
    return name.starts_with('_') && is_name_of_own(name) ? name.substr(1) : name;
}

std::string free_scalar_name(const std::string& wanted, const MeshData& data) {
    const auto is_taken = [&](const std::string& name) {
        return std::ranges::any_of(data.scalars, [&](const ScalarArray& s) { return s.name == name; });
    };
    std::string name = wanted;
    for (int number = 2; is_taken(name); ++number) name = fmt::format("{}_{}", wanted, number);
    return name;
}

}  // namespace

GltfValues values_for_gltf(const MeshData& data) {
    GltfValues values;
    if (data.V.empty()) return values;
    for (const ScalarArray& scalar : data.scalars)
        if (holds_scalar(data, scalar)) values[attribute_name(scalar.name)] = scalar.values;
    if (!data.I.empty()) values[gltf_intensity_name] = data.I;
    if (!data.L.empty() && holds_labels(data)) values[gltf_label_name] = data.L.cast<float>();
    return values;
}

std::vector<std::string> left_out_of_gltf(const MeshData& data) {
    std::vector<std::string> names;
    if (!data.T.empty() || !data.B.empty()) names.emplace_back("tangents");
    if (data.V.empty()) return names;
    if (!data.L.empty() && !holds_labels(data))
        names.emplace_back(data.L.rows() == data.V.rows() ? "labels beyond 2^24" : "labels of faces");
    for (const ScalarArray& scalar : data.scalars)
        if (!scalar.values.empty() && !holds_scalar(data, scalar))
            names.push_back(
                fmt::format("scalars '{}' {}", scalar.name,
                            scalar.values.rows() == data.V.rows() ? "with missing values" : "of faces"));
    return names;
}

void find_gltf_values(const GltfDocument& document, const Json& attributes, std::set<std::string>& names) {
    for (const auto& [name, accessor] : attributes.items()) {
        if (!name.starts_with("_") || name.size() < 2) continue;
        try {
            const size_t index = document.integer(attributes, name.c_str());
            if (gltf_rows(document, index).components <= most_value_columns) names.insert(name);
        } catch (const FormatError&) {
            // Matrices of 3 x 3, and whatever else a program keeps there.
        }
    }
}

void add_gltf_values(const std::string& attribute, const ArrayXf::Dense& values,
                     const std::vector<RoundingCounts>& rounding, const std::filesystem::path& path,
                     MeshData& data) {
    if (attribute == gltf_label_name && data.L.empty() && are_labels(values)) {
        data.L = Array1i::Dense(values.col(0).cast<int32_t>());
    } else if (attribute == gltf_intensity_name && values.cols() == 1) {
        data.I = Array1f::Dense(values.col(0));
        if (!rounding.empty()) warn_of_rounded_intensities(path.string(), rounding[0]);
    } else {
        const std::string name = scalar_name_of(attribute);
        for (Eigen::Index i = 0; i < values.cols(); ++i) {
            const std::string own = values.cols() == 1 ? name : fmt::format("{}_{}", name, i);
            data.scalars.push_back({free_scalar_name(own, data), Array1f::Dense(values.col(i)), true});
            if (size_t(i) < rounding.size())
                warn_of_rounding(path.string(), data.scalars.back().name, rounding[size_t(i)]);
        }
    }
}

}  // namespace easypbr::io
