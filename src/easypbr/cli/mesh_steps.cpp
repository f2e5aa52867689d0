#include "easypbr/cli/mesh_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "easypbr/core/ascii.h"
#include "easypbr/core/error.h"
#include "easypbr/geometry/place.h"
#include "easypbr/geometry/remesh.h"
#include "easypbr/geometry/repair.h"
#include "easypbr/geometry/require.h"
#include "easypbr/geometry/sample.h"
#include "easypbr/geometry/surfels.h"
#include "easypbr/geometry/tubes.h"

namespace easypbr::cli {
namespace {

/// Throws ArgumentError for a number that no mesh makes right.
template <class Number>
using Check = void (*)(const char* option, Number value);

void a_number(const char* option, double value) {
    if (std::isnan(value)) throw ArgumentError(fmt::format("{}: expected a number, got nan", option));
}

void a_factor(const char* option, double value) {
    if (!std::isfinite(value) || value == 0)
        throw ArgumentError(fmt::format("{}: expected a finite number other than 0, got {}", option, value));
}

template <class Number, Number least>
void at_least(const char* option, Number value) {
    if (value < least)
        throw ArgumentError(fmt::format("{}: expected a whole number >= {}, got {}", option, least, value));
}

template <class Number, geometry::Range range>
void in_range(const char* option, Number value) {
    geometry::require_in(option, value, range);
}

/// Adds options that append steps.
class StepOptions {
  public:
    StepOptions(CLI::App& command, std::vector<MeshStep>& steps) : command_(command), steps_(steps) {}

    /// An option with a number.
    template <class Number>
    void number(const char* name, const char* unit, const char* doc, Check<Number> check,
                Mesh (*apply)(const Mesh&, Number)) {
        command_
            .add_option_function<Number>(
                name,
                [this_steps = &steps_, name, check, apply](Number value) {
                    this_steps->push_back({name, [check, name, value] { check(name, value); },
                                           [apply, value](const Mesh& mesh) { return apply(mesh, value); }});
                },
                doc)
            ->option_text(unit)
            ->trigger_on_parse();
    }

    /// An option with so many numbers, separated by commas or blanks.
    template <size_t count>
    void numbers(const char* name, const char* unit, const char* doc,
                 Check<const std::array<double, count>&> check,
                 Mesh (*apply)(const Mesh&, const std::array<double, count>&)) {
        command_
            .add_option_function<std::vector<double>>(
                name,
                [this_steps = &steps_, name, check, apply](const std::vector<double>& given) {
                    std::array<double, count> values;
                    std::ranges::copy(given, values.begin());
                    this_steps->push_back(
                        {name, [check, name, values] { check(name, values); },
                         [apply, values](const Mesh& mesh) { return apply(mesh, values); }});
                },
                doc)
            ->option_text(unit)
            ->delimiter(',')
            ->expected(int(count))
            ->trigger_on_parse();
    }

    void flag(const char* name, const char* doc, Mesh (*apply)(const Mesh&)) {
        command_
            .add_flag_callback(
                name,
                [this_steps = &steps_, name, apply] {
                    this_steps->push_back({name, [] {}, apply});
                },
                doc)
            ->trigger_on_parse();
    }

  private:
    CLI::App& command_;
    std::vector<MeshStep>& steps_;
};

Mesh merge(const Mesh& mesh) {
    return merged(std::vector{mesh});
}

Mesh clean(const Mesh& mesh) {
    return remove_unreferenced_vertices(remove_degenerate_faces(mesh));
}

void declare_places(StepOptions& steps) {
    steps.flag("--merge", "Merge all parts of the file into one mesh (implied by the other steps)", merge);
    steps.flag("--center", "Move the centre of the bounding box to the origin", centered);
    steps.number<double>("--scale", "X", "Scale about the origin", a_factor,
                         [](const Mesh& mesh, double factor) {
                             return transformed(mesh, Eigen::Affine3d(Eigen::Scaling(factor)));
                         });
    steps.number<double>("--normalize-size", "X", "Scale until the longest side of the bounding box is X",
                         geometry::require_positive<double>, with_size);
}

void declare_repairs(StepOptions& steps) {
    steps.number<double>(
        "--weld", "DISTANCE",
        "Merge vertices within this distance that have the same attributes; 0: equal positions",
        geometry::require_not_negative, [](const Mesh& mesh, double tolerance) {
            return remove_duplicate_vertices(mesh, {tolerance, true});
        });
    steps.flag("--clean", "Remove degenerate faces and unreferenced vertices", clean);
    steps.flag("--flip-winding", "Reverse the winding order of the faces", flip_winding);
    steps.flag("--flip-normals", "Negate the normals", flip_normals);
}

void declare_resolutions(StepOptions& steps) {
    steps.number<int64_t>("--subsample", "N", "Keep N random vertices", at_least<int64_t, 1>,
                          [](const Mesh& mesh, int64_t count) { return subsample_random(mesh, count); });
    steps.number<double>("--subsample-cells", "EDGE",
                         "Keep the mean vertex of each cell of a grid of this edge length",
                         geometry::require_positive<double>, subsample_voxels);
    steps.number<double>("--voxelize", "EDGE",
                         "Keep the centre of each occupied cell of a grid of this edge length",
                         geometry::require_positive<double>, voxelize);
    steps.number<int>("--decimate", "N", "Simplify to at most N faces", at_least<int, 0>,
                      [](const Mesh& mesh, int faces) {
                          return decimate(mesh, {faces, {}});
                      });
    steps.number<double>("--decimate-error", "X", "Simplify up to a surface error of at most X",
                         geometry::require_not_negative, [](const Mesh& mesh, double error) {
                             return decimate(mesh, {{}, error});
                         });
    steps.number<int>("--upsample", "N", "Subdivide every face into four, N times",
                      in_range<int, geometry::upsample_iterations>,
                      [](const Mesh& mesh, int iterations) { return upsample(mesh, iterations); });
    steps.number<int>("--smooth", "N", "Apply N iterations of Taubin smoothing",
                      in_range<int, geometry::smooth_iterations>,
                      [](const Mesh& mesh, int iterations) { return smooth(mesh, iterations); });
}

/// A file of no points is none.
constexpr geometry::Range some_samples{1, geometry::sample_counts.most};

void declare_points(StepOptions& steps) {
    steps.number<int64_t>("--sample-surface", "N", "Sample N points on the surface, uniform by area",
                          in_range<int64_t, some_samples>,
                          [](const Mesh& mesh, int64_t count) { return sample_surface(mesh, count); });
    steps.number<int>("--estimate-normals", "K",
                      "Estimate normals from the K nearest neighbours of each vertex",
                      in_range<int, geometry::neighbor_counts>, [](const Mesh& mesh, int k) {
                          return estimate_normals(mesh, {k, {}});
                      });
    steps.number<int>("--estimate-surfels", "K",
                      "Estimate surfels from the K nearest neighbours of each vertex",
                      in_range<int, geometry::neighbor_counts>, [](const Mesh& mesh, int k) {
                          return estimate_surfels(mesh, {k, {}});
                      });
    steps.flag("--to-surfels", "Make one surfel per vertex of a mesh, or per splat", surfels_from_mesh);
}

Box3d corners_box(const std::array<double, 6>& v) {
    return Box3d(Vec3d(v[0], v[1], v[2]), Vec3d(v[3], v[4], v[5]));
}

template <Keep keep>
Mesh cut_by_box(const Mesh& mesh, const std::array<double, 6>& v) {
    return crop_box(mesh, corners_box(v), keep);
}

template <Keep keep>
Mesh cut_by_sphere(const Mesh& mesh, const std::array<double, 4>& v) {
    return crop_sphere(mesh, Vec3d(v[0], v[1], v[2]), v[3], keep);
}

void check_box(const char* option, const std::array<double, 6>& v) {
    geometry::require_box(option, corners_box(v));
}

void check_sphere(const char* option, const std::array<double, 4>& v) {
    geometry::require_sphere(option, Vec3d(v[0], v[1], v[2]), v[3]);
}

void declare_cuts(StepOptions& steps) {
    constexpr const char *box = "X,Y,Z,X,Y,Z", *sphere = "X,Y,Z,RADIUS";
    steps.numbers<6>("--crop-box", box, "Keep what lies between two corners, the lowest first", check_box,
                     cut_by_box<Keep::inside>);
    steps.numbers<6>("--cut-box", box, "Remove what lies between two corners, the lowest first", check_box,
                     cut_by_box<Keep::outside>);
    steps.numbers<4>("--crop-sphere", sphere, "Keep what lies within a sphere", check_sphere,
                     cut_by_sphere<Keep::inside>);
    steps.numbers<4>("--cut-sphere", sphere, "Remove what lies within a sphere", check_sphere,
                     cut_by_sphere<Keep::outside>);
}

void declare_splats(StepOptions& steps) {
    steps.number<double>(
        "--prune-opacity", "X", "Remove splats of an opacity below X", a_number,
        [](const Mesh& mesh, double opacity) { return prune_splats(mesh, {.least_opacity = opacity}); });
    steps.number<double>(
        "--prune-size", "X", "Remove splats of a standard deviation above X", a_number,
        [](const Mesh& mesh, double size) { return prune_splats(mesh, {.most_size = size}); });
    steps.number<int64_t>("--decimate-splats", "N", "Merge neighbouring splats until N are left",
                          at_least<int64_t, 1>,
                          [](const Mesh& mesh, int64_t count) { return decimate_splats(mesh, count); });
    steps.flag("--to-cloud", "Make a cloud of the means of splats", cloud_from_splats);
    steps.number<int>(
        "--to-mesh", "N", "Make a mesh of the surface of splats, N cells along the longest side",
        in_range<int, geometry::splat_mesh_resolutions>,
        [](const Mesh& mesh, int resolution) { return mesh_from_splats(mesh, {.resolution = resolution}); });
}

void declare_lines(StepOptions& steps) {
    steps.number<double>(
        "--tubes", "RADIUS", "Make closed tubes of this radius along the lines, beside the faces",
        geometry::require_positive<double>,
        [](const Mesh& mesh, double radius) { return make_tubes(mesh, {.radius = radius}); });
}

/// The option in place of the function that a message begins with: "crop_box: expected ...".
std::string message_of(const MeshStep& step, std::string_view message) {
    const size_t colon = message.find(": ");
    const std::string_view first = message.substr(0, colon);
    const bool is_function = colon != message.npos && std::ranges::all_of(first, [](char c) {
                                 return ascii::is_lower(c) || c == '_';
                             });
    return fmt::format("{}: {}", step.option, is_function ? message.substr(colon + 2) : message);
}

}  // namespace

void declare_mesh_steps(CLI::App& command, std::vector<MeshStep>& steps) {
    StepOptions options(command, steps);
    declare_places(options);
    declare_repairs(options);
    declare_resolutions(options);
    declare_points(options);
    declare_cuts(options);
    declare_splats(options);
    declare_lines(options);
}

void check_mesh_steps(const std::vector<MeshStep>& steps) {
    for (const MeshStep& step : steps) step.check();
}

Mesh apply_mesh_steps(const Mesh& mesh, const std::vector<MeshStep>& steps, Phases& phases) {
    if (steps.empty()) return mesh;
    phases.begin("--merge");
    Mesh result = merge(mesh);
    for (const MeshStep& step : steps) {
        phases.begin(step.option);
        try {
            result = step.apply(result);
        } catch (const ArgumentError& error) {
            throw ArgumentError(message_of(step, error.what()));
        }
    }
    return result;
}

}  // namespace easypbr::cli
