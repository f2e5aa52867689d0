#include "easypbr/io/tables/vertex_arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "easypbr/core/ascii.h"
#include "easypbr/core/log.h"
#include "easypbr/core/memory_budget.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/tables/attributes.h"
#include "easypbr/io/tables/splat_names.h"
#include "easypbr/scene/color_range.h"
#include "easypbr/scene/mesh_arrays.h"
#include "easypbr/scene/offset.h"

namespace easypbr::io {
namespace {

constexpr size_t array_grain = 1 << 15;

using Names = std::vector<std::string_view>;
using Spellings = std::vector<Names>;

const Spellings position_names{{"x", "y", "z"},
                               {"easting", "northing", "height"},
                               {"easting", "northing", "elevation"},
                               {"points:0", "points:1", "points:2"}};
const Spellings normal_names{
    {"nx", "ny", "nz"}, {"normal_x", "normal_y", "normal_z"}, {"normals:0", "normals:1", "normals:2"}};
const Spellings tangent_names{{"tx", "ty", "tz"}};
const Spellings bitangent_names{{"bitangent_length"}};
const Spellings uv_names{{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"tx", "ty"}};
const Spellings color_names{{"red", "green", "blue", "alpha"},
                            {"red", "green", "blue"},
                            {"diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"},
                            {"diffuse_red", "diffuse_green", "diffuse_blue"},
                            {"rf", "gf", "bf", "af"},
                            {"rf", "gf", "bf"},
                            {"r", "g", "b", "a"},
                            {"r", "g", "b"}};
const Spellings label_names{{"label"},          {"labels"},         {"class"},
                            {"classification"}, {"semantic_label"}, {"semantic"}};
const Spellings intensity_names{{"intensity"}, {"intensities"}, {"reflectance"}, {"i"}};

const Spellings packed_color_names{{"rgb"}, {"rgba"}};

/// What else arrays of NPZ files and packed colours are called.
const Spellings array_names{{"voxel_size"}, {"v"},        {"f"},      {"faces"},   {"triangles"},
                            {"e"},          {"edges"},    {"n"},      {"normals"}, {"normal"},
                            {"c"},          {"rgb"},      {"rgba"},   {"uv"},      {"uvs"},
                            {"t"},          {"tangents"}, {"colors"}, {"colours"}, {"color"},
                            {"texcoords"},  {"b"},        {"l"},      {"offset"},  {"bitangent_lengths"}};

/// What a field is called without CloudCompare's prefix.
std::string without_prefix(std::string_view name) {
    constexpr std::string_view prefix = "scalar_";
    return std::string(name.size() > prefix.size() && ascii::to_lower(name.substr(0, prefix.size())) == prefix
                           ? name.substr(prefix.size())
                           : name);
}

bool has_name(const Spellings& spellings, std::string_view name) {
    const std::string plain = ascii::to_lower(without_prefix(name));
    return std::ranges::any_of(
        spellings, [&](const Names& names) { return std::ranges::find(names, plain) != names.end(); });
}

/// Whether a reader would see another meaning in a field that is called as scalars are, or another name.
bool is_reserved(std::string_view name) {
    return is_known_field(name) || has_name(array_names, name) || is_splat_name(name) ||
           without_prefix(name) != name || (name.starts_with('_') && is_reserved(name.substr(1)));
}

/// Places of the first of several spellings of which all fields are there and free.
std::vector<size_t> find_spelling(const std::vector<VertexField>& fields, const Spellings& spellings) {
    for (const bool is_extra : {false, true})
        for (const Names& names : spellings) {
            std::vector<size_t> found;
            for (const std::string_view name : names) {
                const auto it = std::ranges::find_if(fields, [&](const VertexField& field) {
                    return field.column->is_skipped() && field.property.is_extra == is_extra &&
                           ascii::to_lower(without_prefix(field.property.name)) == name;
                });
                if (it != fields.end()) found.push_back(size_t(it - fields.begin()));
            }
            if (found.size() == names.size()) return found;
        }
    return {};
}

template <class Matrix>
void plan_floats(const std::vector<VertexField>& fields, const std::vector<size_t>& found, size_t count,
                 Matrix& matrix) {
    if (found.empty()) return;
    matrix.resize(Eigen::Index(count), Eigen::Index(found.size()));
    if (count == 0) return;  // There is no memory to point into.
    for (size_t i = 0; i < found.size(); ++i) {
        fields[found[i]].column->floats = matrix.data() + i;
        fields[found[i]].column->stride = found.size();
    }
}

/// Colours of these two types span their range; those of others are used for 0 .. 1 and for 0 .. 255.
double color_scale(ScalarType type) {
    return type == ScalarType::uint8 ? 1 / 255.0 : type == ScalarType::uint16 ? 1 / 65535.0 : 1.0;
}

/// Whether red, green, blue (and alpha) are the bytes of this number, whatever its type says. Numbers in
/// texts without types have eight.
bool is_packed_color(const Property& property) {
    return has_name(packed_color_names, property.name) && size_of(property.type) == 4 && !property.is_extra;
}

/// Of the bits 0xAARRGGBB.
ArrayXf::Dense unpack_colors(const std::vector<uint32_t>& bits, Eigen::Index parts) {
    ArrayXf::Dense C(Eigen::Index(bits.size()), parts);
    parallel_for(bits.size(), array_grain, [&](size_t i) {
        for (Eigen::Index k = 0; k < parts; ++k)
            C(Eigen::Index(i), k) = float((bits[i] >> (k == 3 ? 24 : 16 - 8 * k) & 255) * (1 / 255.0));
    });
    return C;
}

/// Brings these columns of colours to 0 .. 1.
void normalize_columns(const std::vector<int>& columns, ArrayXf::Dense& C) {
    if (columns.empty()) return;
    if (Eigen::Index(columns.size()) == C.cols()) {
        normalize_colors(C);
    } else {
        ArrayXf::Dense part = C(Eigen::all, columns);
        normalize_colors(part);
        C(Eigen::all, columns) = part;
    }
    tidy_colors(C);
}

std::unique_ptr<Rounding> rounding_for(const Property& property) {
    if (!is_finer_than_float(property.type)) return nullptr;
    if (!property.missing) return std::make_unique<Rounding>();
    return std::make_unique<Rounding>(*property.missing * property.scale + property.shift);
}

void warn_of_lost(const Source& source, const std::string& name, const Rounding* rounding) {
    if (rounding) warn_of_rounding(source.path.string(), name, rounding->counts());
}

/// Values that stand for none become NaN.
void clear_missing(const Property& property, Array1f::Dense& values) {
    if (!property.missing) return;
    const float missing = float(*property.missing * property.scale + property.shift);
    parallel_for(size_t(values.rows()), array_grain, [&](size_t i) {
        float& value = values[Eigen::Index(i)];
        if (value == missing) value = std::numeric_limits<float>::quiet_NaN();
    });
}

}  // namespace

ColorArrays::ColorArrays(const std::vector<VertexField>& fields, size_t count) {
    const auto color = find_spelling(fields, color_names);
    plan_floats(fields, color, count, C_);
    for (size_t k = 0; k < color.size(); ++k) {
        const VertexField& field = fields[color[k]];
        field.column->scale = color_scale(field.property.type);
        if (field.column->scale == 1) ranged_.push_back(int(k));
    }
    const auto packed = std::ranges::find_if(
        fields, [](const VertexField& field) { return is_packed_color(field.property); });
    if (!color.empty() || packed == fields.end()) return;
    packed_parts_ = ascii::to_lower(without_prefix(packed->property.name)) == "rgba" ? 4 : 3;
    charge_memory(uint64_t(count) * uint64_t(packed_parts_) * sizeof(float), "its colours");
    bits_.resize(count);
    packed->column->bits = bits_.data();
}

ArrayXf::Dense ColorArrays::take() {
    if (packed_parts_)
        C_ = unpack_colors(bits_, packed_parts_);
    else
        normalize_columns(ranged_, C_);
    return std::exchange(*this, {}).C_;
}

VertexArrays::VertexArrays(const std::vector<VertexField>& fields, size_t count) {
    const auto position = find_spelling(fields, position_names);
    if (position.empty()) return;
    charge_memory(uint64_t(count) * fields.size() * sizeof(float), "its points");
    for (const VertexField& field : fields) {
        field.column->scale = field.property.scale;
        field.column->shift = field.property.shift;
    }
    position_ = {position[0], position[1], position[2]};
    plan_floats(fields, position, count, V_);
    for (size_t i = 0; i < 3; ++i) position_columns_[i] = fields[position[i]].column;
    plan_floats(fields, find_spelling(fields, normal_names), count, N_);
    plan_floats(fields, find_spelling(fields, tangent_names), count, T_);
    plan_floats(fields, find_spelling(fields, bitangent_names), count, B_);
    plan_floats(fields, find_spelling(fields, uv_names), count, UV_);
    colors_ = ColorArrays(fields, count);
    if (const auto label = find_spelling(fields, label_names); !label.empty()) {
        L_.resize(Eigen::Index(count));
        fields[label[0]].column->integers = L_.data();
    }
    if (const auto intensity = find_spelling(fields, intensity_names); !intensity.empty()) {
        plan_floats(fields, intensity, count, I_);
        intensity_rounding_ = rounding_for(fields[intensity[0]].property);
        fields[intensity[0]].column->rounding = intensity_rounding_.get();
    }
    plan_scalars(fields, count);
}

void VertexArrays::plan_scalars(const std::vector<VertexField>& fields, size_t count) {
    std::vector<Column*> columns;
    std::set<std::string> taken;
    std::map<std::string, int> numbers;  // Goes on where it ended, for there may be many of one name.
    for (const VertexField& field : fields) {
        if (!field.column->is_skipped() || field.property.name.empty() || field.property.name == "_" ||
            is_packed_color(field.property))
            continue;
        const std::string plain = scalar_name(field.property.name);
        std::string name = plain;
        int& number = numbers.try_emplace(plain, 1).first->second;
        while (!taken.insert(name).second) name = fmt::format("{}_{}", plain, ++number);
        scalars_.push_back(
            {name, field.property, Array1f::Dense(Eigen::Index(count)), rounding_for(field.property)});
        columns.push_back(field.column);
    }
    for (size_t i = 0; i < columns.size(); ++i) {
        columns[i]->floats = scalars_[i].values.data();
        columns[i]->rounding = scalars_[i].rounding.get();
    }
}

void VertexArrays::recentre(std::vector<Vec3d> samples) {
    offset_ = offset_of_samples(std::move(samples));
    for (int axis = 0; axis < 3; ++axis) position_columns_[size_t(axis)]->shift -= offset_[axis];
}

void VertexArrays::recentre_positions() {
    offset_ = choose_offset(size_t(V_.rows()), [&](size_t i) {
        return Vec3d(V_.row(Eigen::Index(i)).transpose().cast<double>());
    });
    if (offset_.isZero(0)) return;
    parallel_for(size_t(V_.rows()), array_grain, [&](size_t i) {
        auto position = V_.row(Eigen::Index(i));
        position = (position.cast<double>() - offset_.transpose()).cast<float>();
    });
}

void VertexArrays::move_into(MeshData& mesh, const Source& source) {
    tidy_normals(N_);
    tidy_uv(UV_);
    mesh.offset = offset_;
    mesh.V = std::move(V_);
    if (N_.size()) mesh.N = std::move(N_);
    if (T_.size()) mesh.T = std::move(T_);
    if (B_.size()) mesh.B = std::move(B_);
    if (ArrayXf::Dense C = colors_.take(); C.size()) mesh.C = std::move(C);
    if (UV_.size()) mesh.UV = std::move(UV_);
    if (L_.size()) mesh.L = std::move(L_);
    if (I_.size()) mesh.I = std::move(I_);
    if (intensity_rounding_) warn_of_rounded_intensities(source.path.string(), intensity_rounding_->counts());
    for (Scalar& scalar : scalars_) {
        warn_of_lost(source, scalar.name, scalar.rounding.get());
        clear_missing(scalar.property, scalar.values);
        mesh.scalars.push_back({scalar.name, std::move(scalar.values)});
    }
    *this = {};
}

void warn_of_left_out_values(const Source& source, std::string_view values, std::string_view why) {
    log_warning(fmt::format("{}: {} of the faces are left out: {}", source.path.string(), values, why));
}

void warn_of_taken_name(const Source& source, const std::string& name) {
    warn_of_left_out_values(source, fmt::format("the scalars '{}'", name), "there are others of that name");
}

FaceArrays::FaceArrays(ElementPlan& plan) {
    std::vector<VertexField> fields;
    for (size_t i = 0; i < plan.columns.size(); ++i)
        if (!plan.element->properties[i].count_type)
            fields.push_back({plan.element->properties[i], &plan.columns[i]});
    const auto rows = Eigen::Index(plan.element->count);
    colors_ = ColorArrays(fields, size_t(rows));
    if (const auto label = find_spelling(fields, label_names); !label.empty()) {
        L_.resize(rows);
        fields[label[0]].column->integers = L_.data();
    }
    for (const VertexField& field : fields) {
        if (!field.column->is_skipped() || has_name(normal_names, field.property.name) ||
            is_packed_color(field.property) || field.property.name == "texnumber")
            continue;
        scalars_.push_back(
            {scalar_name(field.property.name), Array1f::Dense(rows), rounding_for(field.property)});
        field.column->floats = scalars_.back().values.data();
        field.column->rounding = scalars_.back().rounding.get();
    }
}

void FaceArrays::move_into(MeshData& mesh, const Source& source) {
    if (mesh.F.rows() == 0) return;
    std::set<std::string> taken;
    for (const ScalarArray& scalar : mesh.scalars) taken.insert(scalar.name);
    std::erase_if(scalars_, [&](const Scalar& scalar) {
        const bool is_free = taken.insert(scalar.name).second;
        if (!is_free) warn_of_taken_name(source, scalar.name);
        return !is_free;
    });
    const bool has_labels = mesh.L.empty() && L_.size();
    if (L_.size() && !has_labels)
        warn_of_left_out_values(source, "the labels", "the vertices have labels of their own");
    if (!has_labels && scalars_.empty()) return;
    tell_faces_from_vertices(mesh);
    const auto of_triangles = [&](auto& values) {
        std::remove_cvref_t<decltype(values)> result(mesh.F.rows());
        for (Eigen::Index i = 0; i < result.size(); ++i)
            result[i] = values[mesh.source_face.empty() ? i : mesh.source_face[i]];
        return result;
    };
    if (has_labels) mesh.L = of_triangles(L_);
    for (const Scalar& scalar : scalars_) {
        warn_of_lost(source, scalar.name, scalar.rounding.get());
        mesh.scalars.push_back({scalar.name, of_triangles(scalar.values)});
    }
}

void FaceArrays::leave_out(const Source& source, std::string_view why) const {
    if (L_.size()) warn_of_left_out_values(source, "the labels", why);
    for (const Scalar& scalar : scalars_)
        if (scalar.values.size())
            warn_of_left_out_values(source, fmt::format("the scalars '{}'", scalar.name), why);
}

bool is_known_field(std::string_view name) {
    return std::ranges::any_of(std::array{&normal_names, &tangent_names, &bitangent_names, &uv_names,
                                          &color_names, &label_names, &intensity_names},
                               [&](const Spellings* spellings) { return has_name(*spellings, name); }) ||
           is_position_field(name);
}

bool is_position_field(std::string_view name) {
    return has_name(position_names, name);
}

std::string scalar_field_name(const std::string& name) {
    return is_reserved(name) ? "_" + name : name;
}

std::string scalar_name(const std::string& field) {
    return field.starts_with('_') && is_reserved(field.substr(1)) ? field.substr(1) : without_prefix(field);
}

std::vector<std::string> names_of_parts(const std::string& name, size_t count) {
    static const struct {
        Names whole;
        Names parts;
    } known[] = {
        {{"xyz", "pos", "position", "positions", "point", "points", "coord", "coords"}, {"x", "y", "z"}},
        {{"normal", "normals", "n"}, {"nx", "ny", "nz"}},
        {{"rgb", "color", "colors", "c"}, {"red", "green", "blue"}},
        {{"rgb", "rgba", "color", "colors", "c"}, {"red", "green", "blue", "alpha"}},
        {{"uv", "uvs", "texcoord", "texcoords"}, {"u", "v"}}};
    if (count == 1 || name == "_") return std::vector<std::string>(count, name);
    const std::string plain = ascii::to_lower(name);
    for (const auto& entry : known)
        if (entry.parts.size() == count && std::ranges::find(entry.whole, plain) != entry.whole.end())
            return {entry.parts.begin(), entry.parts.end()};
    std::vector<std::string> names;
    for (size_t i = 0; i < count; ++i) names.push_back(fmt::format("{}_{}", name, i));
    return names;
}

void drop_points_without_position(const Source& source, MeshData& mesh) {
    const size_t count = size_t(mesh.V.rows());
    std::vector<size_t> first((count + array_grain - 1) / array_grain + 1, 0);
    const auto is_good = [&](size_t i) { return mesh.V.row(Eigen::Index(i)).allFinite(); };
    parallel_chunks(count, array_grain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) first[begin / array_grain + 1] += is_good(i);
    });
    std::partial_sum(first.begin(), first.end(), first.begin());
    const size_t kept_count = first.back();
    if (kept_count == count && count > 0) return;
    if (kept_count == 0) fail(source, fmt::format("no point of {} has a finite position", count));
    Array1i::Dense kept{Eigen::Index(kept_count)};
    parallel_chunks(count, array_grain, [&](size_t begin, size_t end) {
        size_t next = first[begin / array_grain];
        for (size_t i = begin; i < end; ++i)
            if (is_good(i)) kept(Eigen::Index(next++)) = int32_t(i);
    });
    choose_vertex_rows(mesh, {kept.data(), kept_count});
    mesh.source_vertex = std::move(kept);
    log_warning(fmt::format("{}: {} of {} points have no finite position and are left out",
                            source.path.string(), count - kept_count, count));
}

}  // namespace easypbr::io
