#include "easypbr/cli/mesh_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/geometry/place.h"
#include "easypbr/geometry/remesh.h"
#include "easypbr/geometry/repair.h"
#include "easypbr/geometry/sample.h"
#include "easypbr/geometry/surfels.h"

namespace easypbr::cli {
namespace {

/// Adds options that append steps.
class StepOptions {
  public:
    StepOptions(CLI::App& command, std::vector<MeshStep>& steps) : command_(command), steps_(steps) {}

    /// An option with a number.
    template <class Number>
    void number(const char* name, const char* unit, const char* doc, Mesh (*apply)(const Mesh&, Number)) {
        command_
            .add_option_function<Number>(
                name,
                [this_steps = &steps_, name, apply](Number value) {
                    this_steps->push_back(
                        {name, [apply, value](const Mesh& mesh) { return apply(mesh, value); }});
                },
                doc)
            ->option_text(unit)
            ->trigger_on_parse();
    }

    /// An option with so many numbers, separated by commas or blanks.
    template <size_t count>
    void numbers(const char* name, const char* unit, const char* doc,
                 Mesh (*apply)(const Mesh&, const std::array<double, count>&)) {
        command_
            .add_option_function<std::vector<double>>(
                name,
                [this_steps = &steps_, name, apply](const std::vector<double>& given) {
                    std::array<double, count> values;
                    std::ranges::copy(given, values.begin());
                    this_steps->push_back(
                        {name, [apply, values](const Mesh& mesh) { return apply(mesh, values); }});
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
                    this_steps->push_back({name, apply});
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
    steps.number<double>("--scale", "X", "Scale about the origin", [](const Mesh& mesh, double factor) {
        return transformed(mesh, Eigen::Affine3d(Eigen::Scaling(factor)));
    });
    steps.number<double>("--normalize-size", "X", "Scale until the longest side of the bounding box is X",
                         with_size);
}

void declare_repairs(StepOptions& steps) {
    steps.number<double>(
        "--weld", "DISTANCE",
        "Merge vertices within this distance that have the same attributes; 0: equal positions",
        [](const Mesh& mesh, double tolerance) {
            return remove_duplicate_vertices(mesh, {tolerance, true});
        });
    steps.flag("--clean", "Remove degenerate faces and unreferenced vertices", clean);
    steps.flag("--flip-winding", "Reverse the winding order of the faces", flip_winding);
    steps.flag("--flip-normals", "Negate the normals", flip_normals);
}

void declare_resolutions(StepOptions& steps) {
    steps.number<int64_t>("--subsample", "N", "Keep N random vertices",
                          [](const Mesh& mesh, int64_t count) { return subsample_random(mesh, count); });
    steps.number<double>("--subsample-cells", "EDGE",
                         "Keep the mean vertex of each cell of a grid of this edge length", subsample_voxels);
    steps.number<double>("--voxelize", "EDGE",
                         "Keep the centre of each occupied cell of a grid of this edge length", voxelize);
    steps.number<int>("--decimate", "N", "Simplify to at most N faces", [](const Mesh& mesh, int faces) {
        return decimate(mesh, {faces, {}});
    });
    steps.number<double>("--decimate-error", "X", "Simplify up to a surface error of at most X",
                         [](const Mesh& mesh, double error) {
                             return decimate(mesh, {{}, error});
                         });
    steps.number<int>("--upsample", "N", "Subdivide every face into four, N times",
                      [](const Mesh& mesh, int iterations) { return upsample(mesh, iterations); });
    steps.number<int>("--smooth", "N", "Apply N iterations of Taubin smoothing",
                      [](const Mesh& mesh, int iterations) { return smooth(mesh, iterations); });
}

void declare_points(StepOptions& steps) {
    steps.number<int64_t>("--sample-surface", "N", "Sample N points on the surface, uniform by area",
                          [](const Mesh& mesh, int64_t count) { return sample_surface(mesh, count); });
    steps.number<int>("--estimate-normals", "K",
                      "Estimate normals from the K nearest neighbours of each vertex",
                      [](const Mesh& mesh, int k) {
                          return estimate_normals(mesh, {k, {}});
                      });
    steps.number<int>("--estimate-surfels", "K",
                      "Estimate surfels from the K nearest neighbours of each vertex",
                      [](const Mesh& mesh, int k) {
                          return estimate_surfels(mesh, {k, {}});
                      });
    steps.flag("--to-surfels", "Make one surfel per vertex of a mesh, or per splat", surfels_from_mesh);
}

template <Keep keep>
Mesh cut_by_box(const Mesh& mesh, const std::array<double, 6>& v) {
    return crop_box(mesh, Box3d(Vec3d(v[0], v[1], v[2]), Vec3d(v[3], v[4], v[5])), keep);
}

template <Keep keep>
Mesh cut_by_sphere(const Mesh& mesh, const std::array<double, 4>& v) {
    return crop_sphere(mesh, Vec3d(v[0], v[1], v[2]), v[3], keep);
}

void declare_cuts(StepOptions& steps) {
    constexpr const char *box = "X,Y,Z,X,Y,Z", *sphere = "X,Y,Z,RADIUS";
    steps.numbers<6>("--crop-box", box, "Keep what lies between two corners, the lowest first",
                     cut_by_box<Keep::inside>);
    steps.numbers<6>("--cut-box", box, "Remove what lies between two corners, the lowest first",
                     cut_by_box<Keep::outside>);
    steps.numbers<4>("--crop-sphere", sphere, "Keep what lies within a sphere", cut_by_sphere<Keep::inside>);
    steps.numbers<4>("--cut-sphere", sphere, "Remove what lies within a sphere",
                     cut_by_sphere<Keep::outside>);
}

void declare_splats(StepOptions& steps) {
    steps.number<double>(
        "--prune-opacity", "X", "Remove splats of an opacity below X",
        [](const Mesh& mesh, double opacity) { return prune_splats(mesh, {.least_opacity = opacity}); });
    steps.number<double>(
        "--prune-size", "X", "Remove splats of a standard deviation above X",
        [](const Mesh& mesh, double size) { return prune_splats(mesh, {.most_size = size}); });
    steps.number<int64_t>("--decimate-splats", "N", "Merge neighbouring splats until N are left",
                          [](const Mesh& mesh, int64_t count) { return decimate_splats(mesh, count); });
    steps.flag("--to-cloud", "Make a cloud of the means of splats", cloud_from_splats);
    steps.number<int>(
        "--to-mesh", "N", "Make a mesh of the surface of splats, N cells along the longest side",
        [](const Mesh& mesh, int resolution) { return mesh_from_splats(mesh, {.resolution = resolution}); });
}

/// The option in place of the function that a message begins with: "crop_box: expected ...".
std::string message_of(const MeshStep& step, std::string_view message) {
    const size_t colon = message.find(": ");
    const std::string_view first = message.substr(0, colon);
    const bool is_function = colon != message.npos && std::ranges::all_of(first, [](char c) {
                                 return (c >= 'a' && c <= 'z') || c == '_';
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
