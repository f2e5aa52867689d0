// How an object's colours are decided; what they become stands in element_colors.cpp.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "easypbr/core/error.h"
#include "easypbr/core/suggest.h"
#include "easypbr/scene/element_colors.h"
#include "easypbr/scene/fields.h"

namespace easypbr {
namespace {

/// The value's name as in the table of fields.
std::string text_of(ColorBy by) {
    Style style;
    style.color_by = by;
    return std::get<std::string>(get(style, "color_by").data);
}

const ScalarArray* find_scalar(const MeshData& mesh, const std::string& name) {
    const auto found = std::ranges::find(mesh.scalars, name, &ScalarArray::name);
    return found == mesh.scalars.end() || found->values.empty() ? nullptr : &*found;
}

/// The scalars that colour a mesh when none are named: the first that were added, then the file's first.
const ScalarArray* first_scalar(const MeshData& mesh, bool of_files) {
    for (const bool from_file : {false, true})
        for (const ScalarArray& scalar : mesh.scalars)
            if (!scalar.values.empty() && scalar.from_file == from_file && (of_files || !from_file))
                return &scalar;
    return nullptr;
}

bool has_color_texture(const MeshData& mesh) {
    return !mesh.UV.empty() && std::ranges::any_of(mesh.materials, [](const Material& material) {
        return bool(material.base_color_texture);
    });
}

/// What a style chooses; scalars that are named are chosen.
std::optional<ColorBy> choice_of(const Style& style) {
    if (style.color_by.value()) return style.color_by.value();
    return style.scalar.value() ? std::optional(ColorBy::scalar) : std::nullopt;
}

/// Whether the data have what it takes; `style` names the scalars, if any.
bool can_color(const MeshData& mesh, ColorBy by, const Style& style) {
    switch (by) {
        case ColorBy::solid:
        case ColorBy::height:
            return true;
        case ColorBy::vertex:
            return !mesh.C.empty();
        case ColorBy::texture:
            return has_color_texture(mesh);
        case ColorBy::label:
            return !mesh.L.empty();
        case ColorBy::scalar:
            return style.scalar.value() ? find_scalar(mesh, *style.scalar) != nullptr
                                        : first_scalar(mesh, true) != nullptr;
        case ColorBy::normal:
            return !mesh.N.empty() || !mesh.F.empty();
        case ColorBy::uv:
            return !mesh.UV.empty();
        case ColorBy::intensity:
            return !mesh.I.empty();
    }
    return false;
}

const char* missing(ColorBy by) {
    switch (by) {
        case ColorBy::vertex:
            return "no vertex colours (C)";
        case ColorBy::texture:
            return "no base colour texture, or no texture coordinates (UV)";
        case ColorBy::label:
            return "no labels (L)";
        case ColorBy::scalar:
            return "no scalars";
        case ColorBy::normal:
            return "neither normals (N) nor faces (F)";
        case ColorBy::uv:
            return "no texture coordinates (UV)";
        case ColorBy::intensity:
            return "no intensities (I)";
        default:
            return "nothing";
    }
}

ColorBy natural_choice(const MeshData& mesh, DrawMode mode) {
    // They have colours of their own, which nothing but a choice replaces.
    if (mode == DrawMode::splats) return ColorBy::solid;
    if (!mesh.L.empty()) return ColorBy::label;
    if (has_color_texture(mesh)) return ColorBy::texture;
    if (!mesh.C.empty()) return ColorBy::vertex;
    if (first_scalar(mesh, false)) return ColorBy::scalar;
    return mode != DrawMode::mesh && !mesh.I.empty() ? ColorBy::intensity : ColorBy::solid;
}

/// Makes the plan of one object.
class Planner {
  public:
    Planner(const MeshData& mesh, const Style& overrides, DrawMode mode)
        : mesh_(mesh), overrides_(overrides), mode_(mode) {
        plan_.mode = mode;
    }

    ColorPlan plan(const Eigen::Affine3d& T_world_mesh, const Vec3d& up, const Vec3d& origin) {
        const std::optional<ColorBy> by = chosen();
        plan_.by = by.value_or(natural_choice(mesh_, mode_));
        // Nobody chose: textures and vertex colours count together, as glTF has it.
        plan_.textured = !by || plan_.by == ColorBy::texture;
        plan_.vertex_colors = (!by && mode_ != DrawMode::splats) || plan_.by == ColorBy::vertex;
        switch (plan_.by) {
            case ColorBy::label:
                decide_labels();
                break;
            case ColorBy::scalar:
            case ColorBy::height:
            case ColorBy::intensity:
                decide_values(T_world_mesh, up, origin);
                break;
            case ColorBy::normal:
                decide_normals(T_world_mesh);
                break;
            case ColorBy::uv:
                start_key(mesh_.UV.revision());
                if (mode_ == DrawMode::mesh) plan_.source = ColorSource::coordinates;
                break;
            default:
                return plan_;
        }
        if (plan_.source == ColorSource::material) plan_.source = ColorSource::colors;
        return plan_;
    }

  private:
    /// The override's choice where the data allow it, else the object's own.
    std::optional<ColorBy> chosen() {
        const std::optional<ColorBy> all = choice_of(overrides_), own = choice_of(mesh_.style);
        if (all) {
            Style style = mesh_.style;
            if (overrides_.scalar.value()) style.scalar = *overrides_.scalar;
            if (can_color(mesh_, *all, style)) {
                name_scalar(*all, style);
                return all;
            }
        }
        if (own) {
            require(*own);
            name_scalar(*own, mesh_.style);
        } else {
            name_scalar(natural_choice(mesh_, mode_), {});
        }
        return own;
    }

    void require(ColorBy own) const {
        if (can_color(mesh_, own, mesh_.style)) return;
        if (own == ColorBy::scalar && mesh_.style.scalar.value()) {
            const ScalarArray& empty = scalar_named(mesh_, *mesh_.style.scalar);
            throw ArgumentError(
                fmt::format("mesh '{}': its scalars '{}' hold no values", mesh_.name, empty.name));
        }
        throw ArgumentError(fmt::format("mesh '{}': its style's color_by is {}, but it has {}", mesh_.name,
                                        text_of(own), missing(own)));
    }

    void name_scalar(ColorBy by, const Style& style) {
        if (by != ColorBy::scalar) return;
        plan_.scalar = style.scalar.value() ? *style.scalar : first_scalar(mesh_, true)->name;
    }

    template <class T>
    std::optional<T> style(Override<T> Style::*field) const {
        const std::optional<T>& given = (overrides_.*field).value();
        return given ? given : (mesh_.style.*field).value();
    }

    /// What rows of labels or scalars are drawn as.
    PerElement drawn_as(PerElement data) const { return mode_ == DrawMode::mesh ? data : PerElement::vertex; }

    /// Between the vertices something is drawn that has their values.
    bool interpolates() const { return mode_ == DrawMode::mesh || mode_ == DrawMode::lines; }

    void decide_labels() {
        plan_.exact = true;
        plan_.element = drawn_as(PerElement::face);
        start_key(mesh_.L.revision());
        add_to_key(mesh_.label_map ? mesh_.label_map->revision() : 0, mesh_.F.revision());
    }

    void decide_values(const Eigen::Affine3d& T_world_mesh, const Vec3d& up, const Vec3d& origin) {
        plan_.exact = true;
        plan_.colormap = style(&Style::colormap)
                             .value_or(plan_.by == ColorBy::intensity ? Colormap::grey : Colormap::viridis);
        plan_.scale = style(&Style::color_scale).value_or(ColorScale::linear);
        plan_.steps = style(&Style::color_steps).value_or(0);
        plan_.min = style(&Style::color_min);
        plan_.max = style(&Style::color_max);
        const Vec3 missing = plan_.colormap.is_grey() ? Vec3(1, 0, 1) : Vec3(0.5f, 0.5f, 0.5f);
        plan_.nan_color = style(&Style::nan_color).value_or(missing);
        decide_array(T_world_mesh, up, origin);
        if (interpolates() && plan_.element == PerElement::vertex) plan_.source = ColorSource::values;
        plan_.key += ' ' + plan_.colormap.text();
        add_to_key(plan_.scale, plan_.steps, plan_.min.value_or(NAN), plan_.max.value_or(NAN),
                   plan_.nan_color.x(), plan_.nan_color.y(), plan_.nan_color.z());
    }

    /// The array that the values come from, and the height's direction.
    void decide_array(const Eigen::Affine3d& T_world_mesh, const Vec3d& up, const Vec3d& origin) {
        if (plan_.by == ColorBy::scalar) {
            const Array1f& values = scalar_named(mesh_, plan_.scalar).values;
            plan_.element = drawn_as(element_of(mesh_, values.rows()));
            start_key(values.revision());
            add_to_key(mesh_.F.revision());
        } else if (plan_.by == ColorBy::intensity) {
            start_key(mesh_.I.revision());
        } else {
            plan_.height.head<3>() = T_world_mesh.linear().transpose() * up;
            plan_.height[3] = up.dot(T_world_mesh.translation());
            // Relative to the origin heights keep their digits; logarithms are those of true values.
            (plan_.scale == ColorScale::linear ? plan_.base : plan_.height[3]) += up.dot(origin);
            start_key(mesh_.V.revision());
            add_to_key(plan_.height[0], plan_.height[1], plan_.height[2], plan_.height[3], plan_.base);
        }
    }

    void decide_normals(const Eigen::Affine3d& T_world_mesh) {
        const bool flat = style(&Style::flat).value_or(false) && mode_ == DrawMode::mesh;
        if (flat) plan_.element = PerElement::face;
        plan_.normal_to_world = T_world_mesh.linear().inverse().transpose();
        if (!plan_.normal_to_world.allFinite()) plan_.normal_to_world.setIdentity();
        start_key(mesh_.N.empty() || flat ? mesh_.V.revision() : mesh_.N.revision());
        add_to_key(mesh_.F.revision());
        for (const double entry : plan_.normal_to_world.reshaped()) add_to_key(entry);
    }

    void start_key(uint64_t revision) {
        // What stands for single vertices is coloured alike.
        const DrawMode alike = interpolates() ? mode_ : DrawMode::points;
        plan_.key = fmt::format("{} {} {} {}", int(plan_.by), int(alike), int(plan_.element), revision);
    }
    template <class... Numbers>
    void add_to_key(Numbers... numbers) {
        const auto add = [this](auto number) {
            if constexpr (std::is_enum_v<decltype(number)>)
                fmt::format_to(std::back_inserter(plan_.key), " {}", int(number));
            else
                fmt::format_to(std::back_inserter(plan_.key), " {}", number);
        };
        (add(numbers), ...);
    }

    const MeshData& mesh_;
    const Style& overrides_;
    DrawMode mode_;
    ColorPlan plan_;
};

}  // namespace

ColorPlan plan_colors(const MeshData& mesh, const Style& overrides, DrawMode mode,
                      const Eigen::Affine3d& T_world_mesh, const Vec3d& up, const Vec3d& origin) {
    return Planner(mesh, overrides, mode).plan(T_world_mesh, up, origin);
}

void require_colors(const SceneSnapshot& scene, const Style& overrides) {
    const std::optional<ColorBy> by = choice_of(overrides);
    if (!by || scene.objects.empty()) return;
    std::vector<std::string> scalars;
    for (const SceneSnapshot::Object& object : scene.objects) {
        Style style = object.mesh->style;
        if (overrides.scalar.value()) style.scalar = *overrides.scalar;
        if (can_color(*object.mesh, *by, style)) return;
        for (const ScalarArray& scalar : object.mesh->scalars) scalars.push_back(scalar.name);
    }
    if (*by == ColorBy::scalar && overrides.scalar.value())
        throw NameError(
            fmt::format("style.scalar: no object has scalars '{}'{}; there {}", *overrides.scalar,
                        did_you_mean(*overrides.scalar, scalars),
                        scalars.empty() ? "are none" : fmt::format("are {}", fmt::join(scalars, ", "))));
    throw ArgumentError(
        fmt::format("style.color_by is {}, but the objects have {}", text_of(*by), missing(*by)));
}

}  // namespace easypbr
