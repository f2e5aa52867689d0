// Ground truth: layers and annotations.
#include <fmt/format.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include "easypbr/dataset/cuda_layers.h"
#include "easypbr/dataset/ground_truth.h"
#include "easypbr/dataset/rle.h"
#include "easypbr/python/pickle.h"
#include "easypbr/python/shared_viewer.h"
#include "easypbr/python/text.h"

namespace easypbr::python {
namespace {

using dataset::Bitmap;
using dataset::GroundTruth;
using dataset::Instance;

template <class T>
nb::object layer_to_numpy(std::vector<T> values, const dataset::LayerArray& layer) {
    auto* held = new std::vector<T>(std::move(values));
    nb::capsule owner(held, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    const size_t shape[3] = {size_t(layer.height), size_t(layer.width), size_t(layer.channels)};
    return nb::cast(nb::ndarray<nb::numpy, T>(held->data(), layer.channels == 1 ? 2 : 3, shape, owner));
}

nb::object layer_to_numpy(const std::string& name, dataset::LayerArray layer) {
    nb::object array =
        std::visit([&](auto& values) { return layer_to_numpy(std::move(values), layer); }, layer.values);
    const bool flags = name.starts_with("occlusion_");
    return flags ? array.attr("view")("bool") : array;
}

nb::object box_tuple(const dataset::PixelBox& box) {
    return nb::make_tuple(box.x, box.y, box.width, box.height);
}

std::vector<uint8_t> whole(const Bitmap& bitmap, Vec2i size) {
    std::vector<uint8_t> mask(size_t(size.x()) * size_t(size.y()));
    for (int y = 0; y < bitmap.area.height; ++y)
        std::copy_n(bitmap.pixels.begin() + long(y) * bitmap.area.width, bitmap.area.width,
                    mask.begin() + long(bitmap.area.y + y) * size.x() + bitmap.area.x);
    return mask;
}

nb::object mask_to_numpy(const Bitmap& bitmap, Vec2i size) {
    dataset::LayerArray layer{size.x(), size.y(), 1, whole(bitmap, size)};
    return layer_to_numpy("", std::move(layer)).attr("view")("bool");
}

nb::object rle_of(const Bitmap& bitmap, Vec2i size) {
    nb::dict rle;
    rle["size"] = nb::make_tuple(size.y(), size.x());
    rle["counts"] = dataset::rle_string(dataset::rle_counts(whole(bitmap, size), size.x(), size.y()));
    return rle;
}

nb::dict ground_truth(SharedViewer& self, const std::vector<std::string>& layers, const nb::object& size,
                      std::optional<int> samples, const std::string& instances_by,
                      const std::map<std::string, int>& classes, const app::Moment* previous,
                      const app::Moment* next, bool instances, bool amodal) {
    dataset::TruthOptions options;
    options.size = optional_size(size);
    options.samples = samples;
    options.instances_by = dataset::instances_by_named(instances_by);
    options.classes = classes;
    options.previous = previous;
    options.next = next;
    options.instances = instances;
    options.amodal = amodal;
    GroundTruth truth =
        self.run([&](Viewer& viewer) { return dataset::ground_truth(viewer.session(), layers, options); });
    nb::dict result;
    for (const std::string& name : layers)
        if (truth.layers.contains(name)) {
            result[name.c_str()] = layer_to_numpy(name, std::move(truth.layers.at(name)));
            truth.layers.erase(name);
        }
    if (instances) result["instances"] = truth.instances;
    return result;
}

/// What torch knows of a target's pixels: 16-bit fractions and whole numbers are given with a sign.
nb::object target_to_dlpack(gl::CudaPixels pixels) {
    struct Kind {
        size_t channels;
        nb::dlpack::dtype type;
    };
    const auto kind = [&]() -> Kind {
        switch (pixels.format()) {
            case gl::Format::rgba8:
                return {4, nb::dtype<uint8_t>()};
            case gl::Format::rg16:
                return {2, nb::dtype<int16_t>()};
            case gl::Format::rgba16:
                return {4, nb::dtype<int16_t>()};
            case gl::Format::r32f:
                return {1, nb::dtype<float>()};
            case gl::Format::r32ui:
                return {1, nb::dtype<int32_t>()};
            case gl::Format::rgba16f:
                return {4, {uint8_t(nb::dlpack::dtype_code::Float), 16, 1}};
            default:
                return {4, nb::dtype<float>()};
        }
    }();
    auto* held = new gl::CudaPixels(std::move(pixels));
    nb::capsule owner(held, [](void* p) noexcept { delete static_cast<gl::CudaPixels*>(p); });
    const size_t shape[3] = {size_t(held->height()), size_t(held->width()), kind.channels};
    return nb::cast(nb::ndarray<>(reinterpret_cast<void*>(held->address()), 3, shape, owner, nullptr,
                                  kind.type, nb::device::cuda::value, held->device()));
}

nb::object cuda_layers(SharedViewer& self, const std::vector<std::string>& layers, const nb::object& size,
                       std::optional<int> samples, const std::string& instances_by,
                       const std::map<std::string, int>& classes) {
    dataset::TruthOptions options;
    options.size = optional_size(size);
    options.samples = samples;
    options.instances_by = dataset::instances_by_named(instances_by);
    options.classes = classes;
    auto found =
        self.run([&](Viewer& viewer) { return dataset::cuda_layers(viewer.session(), layers, options); });
    if (!found) return nb::none();
    nb::dict targets, result;
    for (auto& [name, pixels] : found->targets) targets[name.c_str()] = target_to_dlpack(std::move(pixels));
    result["targets"] = targets;
    result["near"] = found->near;
    result["far"] = found->far;
    result["orthographic"] = found->orthographic;
    result["ray_shift"] = nb::make_tuple(found->rays.shift.x(), found->rays.shift.y());
    result["ray_scale"] = nb::make_tuple(found->rays.scale.x(), found->rays.scale.y());
    result["T_world_cam"] = matrix_to_numpy(found->T_world_cam);
    result["instance_ids"] = found->instance_ids;
    result["semantic_ids"] = found->semantic_ids;
    return result;
}

using InstanceClass = nb::class_<Instance>;

void bind_counts(InstanceClass& instance) {
    instance.def_ro("id", &Instance::id, "Value of the layer instance_id, from 1.")
        .def_ro("name", &Instance::name)
        .def_ro("semantic_id", &Instance::semantic_id)
        .def_ro("pixels_visible", &Instance::pixels_visible)
        .def_ro("pixels_amodal", &Instance::pixels_amodal,
                "Pixels of the instance alone, on a canvas three times as wide and high as the image.")
        .def_ro("pixels_amodal_inside", &Instance::pixels_amodal_inside,
                "Pixels of the instance alone, inside the image.")
        .def_ro("visible_fraction", &Instance::visible_fraction,
                "pixels_visible / pixels_amodal, visib_fract of BOP; 0 without amodal pixels.")
        .def_ro("truncation", &Instance::truncation, "Fraction of pixels_amodal outside of the image.")
        .def_prop_ro(
            "box_visible", [](const Instance& i) { return box_tuple(i.box_visible); },
            nb::sig("def box_visible(self) -> tuple[int, int, int, int]"),
            "x, y, width, height in pixels of the visible part; width 0: invisible.")
        .def_prop_ro(
            "box_amodal", [](const Instance& i) { return box_tuple(i.box_amodal); },
            nb::sig("def box_amodal(self) -> tuple[int, int, int, int]"),
            "The same of the instance alone, beyond the image border too.")
        .def_prop_ro(
            "mask", [](const Instance& i) { return mask_to_numpy(i.visible, i.picture); },
            nb::sig("def mask(self) -> numpy.ndarray"), "height x width, bool: the visible part.")
        .def_prop_ro(
            "amodal_mask", [](const Instance& i) { return mask_to_numpy(i.amodal, i.picture); },
            nb::sig("def amodal_mask(self) -> numpy.ndarray"),
            "height x width, bool: the instance alone, without occluders.")
        .def_prop_ro(
            "rle", [](const Instance& i) { return rle_of(i.visible, i.picture); },
            nb::sig("def rle(self) -> dict"),
            "mask as COCO run lengths {'size': (height, width), 'counts': str}.")
        .def_prop_ro(
            "amodal_rle", [](const Instance& i) { return rle_of(i.amodal, i.picture); },
            nb::sig("def amodal_rle(self) -> dict"), "amodal_mask as COCO run lengths.")
        .def("__repr__", [](const Instance& i) {
            return fmt::format("<easypbr.Instance {} '{}': {} pixels, {:.0f} % visible>", i.id, i.name,
                               i.pixels_visible, 100 * i.visible_fraction);
        });
}

void bind_space(InstanceClass& instance) {
    instance
        .def_prop_ro(
            "T_world_obj", [](const Instance& i) { return matrix_to_numpy(i.T_world_obj.matrix()); },
            nb::sig("def T_world_obj(self) -> numpy.ndarray"), "4 x 4 pose in world space.")
        .def_prop_ro(
            "T_cam_obj", [](const Instance& i) { return matrix_to_numpy(i.T_cam_obj.matrix()); },
            nb::sig("def T_cam_obj(self) -> numpy.ndarray"), "4 x 4 pose in camera space, OpenCV axes.")
        .def_prop_ro(
            "box3d_center",
            [](const Instance& i) {
                return matrix_to_numpy(
                    (i.box.isEmpty() ? Vec3d(Vec3d::Zero()) : Vec3d(i.box.center())).transpose());
            },
            nb::sig("def box3d_center(self) -> numpy.ndarray"),
            "Centre of the box of all vertices (of voxels: of their cubes), in object space.")
        .def_prop_ro(
            "box3d_size",
            [](const Instance& i) {
                return matrix_to_numpy(
                    (i.box.isEmpty() ? Vec3d(Vec3d::Zero()) : Vec3d(i.box.sizes())).transpose());
            },
            nb::sig("def box3d_size(self) -> numpy.ndarray"), "Edge lengths of the same box.")
        .def_prop_ro(
            "corners_world", [](const Instance& i) { return matrix_to_numpy(i.corners_world); },
            nb::sig("def corners_world(self) -> numpy.ndarray"),
            "8 x 3 corners of the box; bit 0 of the row is x, bit 1 y, bit 2 z.")
        .def_prop_ro(
            "corners_cam", [](const Instance& i) { return matrix_to_numpy(i.corners_cam); },
            nb::sig("def corners_cam(self) -> numpy.ndarray"), "The same in camera space, OpenCV axes.")
        .def_prop_ro(
            "corners_px", [](const Instance& i) { return matrix_to_numpy(i.corners_px); },
            nb::sig("def corners_px(self) -> numpy.ndarray"),
            "8 x 2 pixels of the projected corners (pixel centres at integers), lens distortion included; "
            "NaN behind the camera and where the polynomial of the lens folds back.");
}

}  // namespace

void bind_ground_truth(nb::module_& module) {
    nb::class_<app::Moment>(module, "Moment",
                            "A scene and its camera at one moment, for optical flow: Viewer.moment().")
        .def("__reduce__", [](const app::Moment&) { refuse_pickle("Moment"); });
    InstanceClass instance(module, "Instance", "Annotation of one instance in an image.");
    bind_counts(instance);
    bind_space(instance);
    bind_pickle(instance);
    module.def(
        "moment",
        [](SharedViewer& self, const nb::object& size) {
            const std::optional<Vec2i> pixels = optional_size(size);
            return self.run([&](Viewer& viewer) { return viewer.session().moment(pixels); });
        },
        nb::arg("viewer"), nb::arg("size").none() = nb::none());
    module.def("ground_truth", ground_truth, nb::arg("viewer"), nb::arg("layers"),
               nb::arg("size").none() = nb::none(), nb::arg("samples").none() = nb::none(),
               nb::arg("instances_by") = "object", nb::arg("classes") = std::map<std::string, int>(),
               nb::arg("previous").none() = nb::none(), nb::arg("next").none() = nb::none(),
               nb::arg("instances") = false, nb::arg("amodal") = true);
    module.def("cuda_layers", cuda_layers, nb::arg("viewer"), nb::arg("layers"), nb::arg("size").none(),
               nb::arg("samples").none(), nb::arg("instances_by"), nb::arg("classes"),
               nb::sig("def cuda_layers(viewer: ViewerHandle, layers: Sequence[str], size: object | None, "
                       "samples: int | None, instances_by: str, classes: Mapping[str, int]) -> dict | None"));
    module.def("cuda_layer_names", [] { return dataset::cuda_layer_names(); });
    module.def("truth_layer_names", [] { return dataset::truth_layer_names(); });
    module.def(
        "rle_encode",
        [](const ArrayLike& mask) {
            Image image = to_image(mask, "mask");
            Bitmap bitmap{{0, 0, image.width(), image.height()}, {}};
            if (image.type() != PixelType::u8 || image.channels() != 1)
                throw ArgumentError("mask: expected height x width of uint8");
            const auto pixels = image.pixels<uint8_t>();
            bitmap.pixels.assign(pixels.begin(), pixels.end());
            return rle_of(bitmap, {image.width(), image.height()});
        },
        nb::arg("mask"), "COCO run lengths of a height x width mask of uint8.");
}

}  // namespace easypbr::python
