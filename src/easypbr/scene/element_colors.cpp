#include "easypbr/scene/element_colors.h"

#include <fmt/format.h>

#include <limits>

#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"
#include "easypbr/scene/label_colors.h"
#include "easypbr/scene/normals.h"

namespace easypbr {
namespace {

constexpr size_t color_grain = 1 << 15;

Rgba8 color_of_direction(const Vec3d& direction) {
    const Vec3d n = direction.squaredNorm() > 0 ? direction.normalized() : Vec3d::Zero();
    return opaque(to_rgb8(Vec3((0.5 * (n.array() + 1)).matrix().cast<float>())));
}

/// Texture coordinates repeat; the end of the first tile is no start of the next one.
float wrapped(float u) {
    return u >= 0 && u <= 1 ? u : u - std::floor(u);
}

template <class ColorOf>
std::vector<Rgba8> colors_of(Eigen::Index count, ColorOf&& color_of) {
    std::vector<Rgba8> colors(static_cast<size_t>(count));
    parallel_for(colors.size(), color_grain, [&](size_t i) { colors[i] = color_of(Eigen::Index(i)); });
    return colors;
}

/// The label that two corners or more have, else the first one's.
int32_t majority(int32_t a, int32_t b, int32_t c) {
    return b == c ? b : a;
}

Array1i labels_of_faces(const MeshData& mesh) {
    Array1i::Dense labels(mesh.F.rows());
    parallel_for(size_t(mesh.F.rows()), color_grain,
                 [&](size_t i) { labels(Eigen::Index(i)) = face_label(mesh, Eigen::Index(i)); });
    return labels;
}

Array1i labels_of_vertices(const MeshData& mesh) {
    Array1i::Dense labels = Array1i::Dense::Constant(mesh.V.rows(), no_label);
    for (Eigen::Index i = mesh.F.rows(); i-- > 0;)
        for (int k = 0; k < 3; ++k) labels(mesh.F(i, k)) = mesh.L(i);
    return labels;
}

Array1f values_of_vertices(const MeshData& mesh, const Array1f& values) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(mesh.V.rows()), count = sum;
    for (Eigen::Index i = 0; i < mesh.F.rows(); ++i) {
        if (std::isnan(values(i))) continue;
        for (int k = 0; k < 3; ++k) {
            sum(mesh.F(i, k)) += values(i);
            count(mesh.F(i, k)) += 1;
        }
    }
    return Array1f::Dense((sum.array() / count.array()).cast<float>());  // 0 / 0 is NaN: no value
}

/// Infinite values as the range's ends: what is interpolated between them is a number, too.
Array1f bounded(const Array1f& values, const ValueRange& range) {
    if (!values.array().isInf().any()) return values;
    Array1f::Dense result(values.rows());
    parallel_for(size_t(values.rows()), color_grain, [&](size_t i) {
        const float value = values(Eigen::Index(i));
        result(Eigen::Index(i)) = !std::isinf(value) ? value : value > 0 ? range.max : range.min;
    });
    return result;
}

std::vector<Rgba8> label_colors(const MeshData& mesh, PerElement element) {
    const bool fits = element_of(mesh, mesh.L.rows()) == element;
    const Array1i labels = fits                          ? mesh.L
                           : element == PerElement::face ? labels_of_faces(mesh)
                                                         : labels_of_vertices(mesh);
    if (mesh.label_map) {
        const LabelMap& map = *mesh.label_map;
        return colors_of(labels.rows(), [&](Eigen::Index i) { return opaque(map.color_of(labels(i))); });
    }
    const GeneratedColors generated(labels.rows() ? labels.maxCoeff() : 0);
    return colors_of(labels.rows(), [&](Eigen::Index i) { return opaque(generated.color_of(labels(i))); });
}

std::vector<Rgba8> normal_colors(const MeshData& mesh, const ColorPlan& plan) {
    const bool flat = plan.element == PerElement::face;
    const Array3f N = flat ? face_normals(mesh.V, mesh.F) : mesh.N.empty() ? smooth_normals(mesh) : mesh.N;
    return colors_of(N.rows(), [&](Eigen::Index i) {
        return color_of_direction(plan.normal_to_world * N.row(i).transpose().cast<double>());
    });
}

std::vector<Rgba8> uv_colors(const MeshData& mesh) {
    return colors_of(mesh.UV.rows(), [&](Eigen::Index i) {
        return opaque(to_rgb8(Vec3(wrapped(mesh.UV(i, 0)), wrapped(mesh.UV(i, 1)), 0)));
    });
}

Array1f heights(const Array3f& V, const Eigen::Vector4d& height) {
    Array1f::Dense values(V.rows());
    parallel_for(size_t(V.rows()), color_grain, [&](size_t i) {
        const Eigen::Index row = Eigen::Index(i);
        values(row) = float(height.head<3>().dot(V.row(row).transpose().cast<double>()) + height[3]);
    });
    return values;
}

}  // namespace

int32_t face_label(const MeshData& mesh, Eigen::Index face) {
    if (element_of(mesh, mesh.L.rows()) == PerElement::face) return mesh.L(face);
    const auto f = mesh.F.row(face);
    return majority(mesh.L(f[0]), mesh.L(f[1]), mesh.L(f[2]));
}

Array1i vertex_labels(const MeshData& mesh) {
    return element_of(mesh, mesh.L.rows()) == PerElement::face ? labels_of_vertices(mesh) : mesh.L;
}

namespace {

Array1f given_values(const MeshData& mesh, const ColorPlan& plan) {
    if (plan.by == ColorBy::scalar) return scalar_named(mesh, plan.scalar).values;
    if (plan.by == ColorBy::height) return heights(mesh.V, plan.height);
    if (plan.by == ColorBy::intensity) return mesh.I;
    return {};
}

/// NaN in place of what has no logarithm.
Array1f above_zero(const Array1f& values) {
    if (!(values.array() <= 0).any()) return values;
    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    return Array1f::Dense((values.array() > 0).select(values.array(), none).matrix());
}

}  // namespace

Array1f plan_values(const MeshData& mesh, const ColorPlan& plan) {
    const Array1f values = given_values(mesh, plan);
    return plan.scale == ColorScale::log ? above_zero(values) : values;
}

ValueRange plan_range(const Array1f& values, const ColorPlan& plan) {
    ValueRange range =
        value_range(values, plan.min, plan.max, plan.colormap.is_diverging(), plan.scale, plan.base);
    range.parts = color_parts(plan.steps);
    return range;
}

std::array<Rgba8, 256> plan_table(const ColorPlan& plan) {
    std::array<Rgba8, 256> table;
    std::ranges::transform(color_table(plan.colormap, plan.steps), table.begin(), opaque);
    return table;
}

ElementColors element_colors(const MeshData& mesh, const ColorPlan& plan) {
    ElementColors result;
    if (plan.source == ColorSource::material || plan.source == ColorSource::coordinates) return result;
    if (plan.by == ColorBy::label) result.colors = label_colors(mesh, plan.element);
    if (plan.by == ColorBy::normal) result.colors = normal_colors(mesh, plan);
    if (plan.by == ColorBy::uv) result.colors = uv_colors(mesh);
    Array1f values = plan_values(mesh, plan);
    if (values.empty()) return result;

    result.range = plan_range(values, plan);
    result.table = plan_table(plan);
    result.nan_color = opaque(to_rgb8(plan.nan_color));
    values = bounded(values, result.range);
    if (element_of(mesh, values.rows()) != plan.element) values = values_of_vertices(mesh, values);
    if (plan.source == ColorSource::values) {
        result.values = values;
    } else {
        result.colors = colors_of(values.rows(), [&](Eigen::Index i) {
            const int index = color_index(values(i), result.range);
            return index < 0 ? result.nan_color : result.table[size_t(index)];
        });
    }
    return result;
}

}  // namespace easypbr
