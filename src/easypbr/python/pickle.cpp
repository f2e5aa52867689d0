#include "easypbr/python/pickle.h"

#include <fmt/format.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/io/settings/camera_path_io.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/pickle_archive.h"
#include "easypbr/python/text.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/light_table.h"
#include "easypbr/scene/material_table.h"

namespace easypbr::python {
namespace pickled {

constexpr std::string_view style_prefix = "style.";

// What objects consist of, for both directions: they are const where they are saved.

template <class Object, class T>
concept Is = std::is_same_v<std::remove_const_t<Object>, T>;

template <class Archive, Is<FileState> Object>
void exchange(Archive& archive, Object& state) {
    archive("size", state.size);
    auto ticks = state.time.time_since_epoch().count();
    archive("time", ticks);
    if constexpr (!std::is_const_v<Object>)
        state.time = std::filesystem::file_time_type(std::filesystem::file_time_type::duration(ticks));
}

template <class Archive, Is<Texture> Object>
void exchange(Archive& archive, Object& texture) {
    archive("image", texture.image);
    archive("path", texture.path);
    archive("file_state", texture.file_state);
    archive.choice("wrap_u", texture.wrap_u, 3);
    archive.choice("wrap_v", texture.wrap_v, 3);
    archive.choice("filter", texture.filter, 2);
    archive("uv_transform", texture.uv_transform);
    archive("channel", texture.channel);
}

template <class Archive, Is<Material> Object>
void exchange(Archive& archive, Object& material) {
    archive("name", material.name);
    for (const MaterialColor& color : material_colors()) archive(color.name, material.*color.value);
    for (const MaterialNumber& number : material_numbers()) archive(number.name, material.*number.value);
    for (const MaterialTexture& use : material_textures())
        archive((std::string(use.name) + "_texture").c_str(), material.*use.texture);
    archive("double_sided", material.double_sided);
    archive("unlit", material.unlit);
    archive("base_color_given", material.base_color_given);
    archive("shader_text", material.shader.text);
    archive("shader_path", material.shader.path);
    // 0: automatic.
    int mode = material.alpha_mode.value() ? 1 + int(*material.alpha_mode) : 0;
    archive.choice("alpha_mode", mode, 4);
    if constexpr (!std::is_const_v<Object>)
        material.alpha_mode = mode == 0 ? Auto<AlphaMode>() : Auto<AlphaMode>(AlphaMode(mode - 1));
}

template <class Archive, Is<MeshPart> Object>
void exchange(Archive& archive, Object& part) {
    archive("name", part.name);
    archive("first_face", part.first_face);
    archive("face_count", part.face_count);
    archive("material", part.material);
}

template <class Archive, Is<ScalarArray> Object>
void exchange(Archive& archive, Object& scalar) {
    archive("name", scalar.name);
    archive("values", scalar.values);
    archive("from_file", scalar.from_file);
}

template <class Archive, Is<MeshData> Object>
void exchange(Archive& archive, Object& mesh) {
    archive("name", mesh.name);
    archive("source", mesh.source);
    archive("V", mesh.V);
    archive("N", mesh.N);
    archive("C", mesh.C);
    archive("UV", mesh.UV);
    archive("uv_tangents", mesh.uv_tangents);
    archive("T", mesh.T);
    archive("B", mesh.B);
    archive("F", mesh.F);
    archive("E", mesh.E);
    archive("L", mesh.L);
    archive("I", mesh.I);
    archive("scales", mesh.splats.scales);
    archive("rotations", mesh.splats.rotations);
    archive("opacities", mesh.splats.opacities);
    archive("sh", mesh.splats.sh);
    archive("scalars", mesh.scalars);
    archive("label_map", mesh.label_map);
    archive("offset", mesh.offset);
    archive("up", mesh.up);
    archive("front", mesh.front);
    archive("voxel_size", mesh.voxel_size);
    archive("source_vertex", mesh.source_vertex);
    archive("source_face", mesh.source_face);
    archive("materials", mesh.materials);
    archive("parts", mesh.parts);
    archive("style", mesh.style);
    archive("T_parent_mesh", mesh.T_parent_mesh.matrix());
    archive("children", mesh.children);
    // It is for the faces that the mesh has.
    if (!std::is_const_v<Object> || mesh.rest_shape.F_revision == mesh.F.revision())
        archive("rest_V", mesh.rest_shape.V);
    if constexpr (!std::is_const_v<Object>) mesh.rest_shape.F_revision = mesh.F.revision();
}

template <class Archive, Is<Intrinsics> Object>
void exchange(Archive& archive, Object& intrinsics) {
    archive("fx", intrinsics.fx);
    archive("fy", intrinsics.fy);
    archive("cx", intrinsics.cx);
    archive("cy", intrinsics.cy);
    archive("width", intrinsics.width);
    archive("height", intrinsics.height);
    archive("skew", intrinsics.skew);
}

template <class Archive, Is<Distortion> Object>
void exchange(Archive& archive, Object& distortion) {
    archive.choice("model", distortion.model, 2);
    archive("k", distortion.k);
}

template <class Archive, Is<Camera> Object>
void exchange(Archive& archive, Object& camera) {
    archive("T_world_cam", camera.T_world_cam.matrix());
    archive.choice("projection", camera.projection, 2);
    archive("fov_y_deg", camera.fov_y_deg);
    archive("ortho_height", camera.ortho_height);
    archive("near", camera.near);
    archive("far", camera.far);
    archive("intrinsics", camera.intrinsics);
    archive("distortion", camera.distortion);
}

template <class Archive, Is<PixelRect> Object>
void exchange(Archive& archive, Object& rectangle) {
    archive("x", rectangle.x);
    archive("y", rectangle.y);
    archive("width", rectangle.width);
    archive("height", rectangle.height);
}

template <class Archive, Is<dataset::Bitmap> Object>
void exchange(Archive& archive, Object& bitmap) {
    archive("area", bitmap.area);
    archive("pixels", bitmap.pixels);
}

template <class Archive, Is<dataset::Instance> Object>
void exchange(Archive& archive, Object& instance) {
    archive("id", instance.id);
    archive("name", instance.name);
    archive("semantic_id", instance.semantic_id);
    archive("pixels_visible", instance.pixels_visible);
    archive("pixels_amodal_inside", instance.pixels_amodal_inside);
    archive("pixels_amodal", instance.pixels_amodal);
    archive("visible_fraction", instance.visible_fraction);
    archive("truncation", instance.truncation);
    archive("box_visible", instance.box_visible);
    archive("box_amodal", instance.box_amodal);
    archive("picture_width", instance.picture.x());
    archive("picture_height", instance.picture.y());
    archive("visible", instance.visible);
    archive("amodal", instance.amodal);
    archive("T_world_obj", instance.T_world_obj.matrix());
    archive("T_cam_obj", instance.T_cam_obj.matrix());
    archive("box_min", (instance.box.min)());
    archive("box_max", (instance.box.max)());
    archive("corners_world", instance.corners_world);
    archive("corners_cam", instance.corners_cam);
    archive("corners_px", instance.corners_px);
}

template <class Archive, Is<app::Pick> Object>
void exchange(Archive& archive, Object& pick) {
    archive("object", pick.object);
    archive("part", pick.part);
    archive("part_index", pick.part_index);
    archive("is_face", pick.is_face);
    archive("element", pick.element);
    archive("position", pick.position);
    archive("depth", pick.depth);
}

/// Masks are made of it, by pixels of the picture.
void check(const dataset::Bitmap& bitmap, const Vec2i& picture) {
    const PixelRect& area = bitmap.area;
    const auto is_within = [](int first, int count, int all) {
        return count >= 0 && (count == 0 || (first >= 0 && first <= all - count));
    };
    if (is_within(area.x, area.width, picture.x()) && is_within(area.y, area.height, picture.y()) &&
        bitmap.pixels.size() == size_t(area.width) * size_t(area.height))
        return;
    throw ArgumentError("pickle: Instance: expected masks within the picture, with a byte for each pixel");
}

nb::dict style_state(const Style& style) {
    nb::dict state;
    for (const Field& field : fields()) {
        if (!field.name.starts_with(style_prefix)) continue;
        const std::string name = field.name.substr(style_prefix.size());
        if (const Value value = get(style, name); value.state == Value::State::given)
            state[name.c_str()] = value_to_python(field, value);
    }
    return state;
}

Style style_of(const nb::dict& state) {
    Style style;
    for (auto [key, object] : state) {
        const std::string name = nb::cast<std::string>(key);
        const Field& own = field(std::string(style_prefix) + name);
        set(style, name, checked(own, value_from_python(own, object)));
    }
    return style;
}

nb::object Saved::object_of(const Style& style) {
    return style_state(style);
}

nb::object Saved::object_of(const MeshList& children) {
    nb::list list;
    for (const Mesh& child : children) list.append(object_of(*child.snapshot()));
    return list.size() ? nb::object(list) : nb::none();
}

void Loaded::load(const nb::object& object, Style& style, const char*) {
    style = style_of(nb::cast<nb::dict>(object));
}

void Loaded::load(const nb::object& object, MeshList& children, const char* name) {
    children.clear();
    for (nb::handle item : object) {
        MeshData child;
        load(nb::borrow(item), child, name);
        children.emplace_back(std::move(child));
    }
}

template <class T>
nb::dict state_of(const T& object) {
    Saved::Shared shared;
    Saved members(shared);
    exchange(members, object);
    return members.state();
}

template <class T>
T object_of(const nb::dict& state) {
    Loaded::Shared shared;
    Loaded members(state, shared);
    T object;
    exchange(members, object);
    members.finish();
    return object;
}

/// `save` gives the state of an object, `make` the object of a state.
template <class Class, class Save, class Make>
void bind_state(nb::class_<Class>& type, Save save, Make make) {
    type.def("__getstate__", save);
    type.def(
        "__setstate__", [make](Class& self, const nb::dict& state) { new (&self) Class(make(state)); },
        nb::arg("state"));
}

}  // namespace pickled

void bind_pickle(nb::class_<Mesh>& mesh) {
    pickled::bind_state(
        mesh, [](const Mesh& m) { return pickled::state_of(*m.snapshot()); },
        [](const nb::dict& state) {
            auto data = pickled::object_of<MeshData>(state);
            return released([&] { return Mesh(std::move(data)); });
        });
}

void bind_pickle(nb::class_<MaterialHandle>& material) {
    pickled::bind_state(
        material, [](const MaterialHandle& m) { return pickled::state_of(m.get()); },
        [](const nb::dict& state) {
            MaterialHandle handle{{}, 0, pickled::object_of<Material>(state)};
            validate(handle.own);
            return handle;
        });
}

void bind_pickle(nb::class_<StyleHandle>& style) {
    pickled::bind_state(
        style, [](const StyleHandle& s) { return pickled::style_state(s.get()); },
        [](const nb::dict& state) {
            return StyleHandle{{}, pickled::style_of(state)};
        });
}

void bind_pickle(nb::class_<Camera>& camera) {
    pickled::bind_state(camera, pickled::state_of<Camera>, pickled::object_of<Camera>);
}

void bind_pickle(nb::class_<CameraPath>& path) {
    pickled::bind_state(
        path,
        [](const CameraPath& p) {
            nb::dict state;
            state["json"] = io::to_json(p);
            return state;
        },
        [](const nb::dict& state) {
            return io::parse_camera_path(nb::cast<std::string>(state["json"]), "pickle");
        });
}

void bind_pickle(nb::class_<Light>& light) {
    pickled::bind_state(
        light,
        [](const Light& l) {
            nb::dict state;
            for (const LightField& field : light_fields())
                state[field.name.c_str()] = value_to_python(field, field.get(l));
            return state;
        },
        [](const nb::dict& state) {
            Light light;
            for (const LightField& field : light_fields())
                if (state.contains(field.name.c_str()))
                    field.put(light,
                              checked(field, value_from_python(field, state[field.name.c_str()]), "light."));
            return light;
        });
}

void bind_pickle(nb::class_<Environment>& environment) {
    pickled::bind_state(
        environment,
        [](const Environment& e) {
            nb::dict state;
            if (e.empty()) return state;
            state["image"] = to_numpy(e.image());
            state["name"] = e.name();
            return state;
        },
        [](const nb::dict& state) {
            if (!state.contains("image")) return Environment();
            Image image = to_image(state["image"], "environment");
            const auto name = nb::cast<std::string>(state["name"]);
            return released([&] { return Environment(std::move(image), name); });
        });
}

void bind_pickle(nb::class_<Automatic>& automatic) {
    pickled::bind_state(
        automatic,
        [](const Automatic& a) {
            nb::dict state;
            if (a.value) state["value"] = *a.value;
            return state;
        },
        [](const nb::dict& state) {
            Automatic automatic;
            if (state.contains("value")) automatic.value = nb::cast<Value::Data>(state["value"]);
            return automatic;
        });
}

void bind_pickle(nb::class_<Follow>& follow) {
    pickled::bind_state(
        follow, [](const Follow&) { return nb::dict(); }, [](const nb::dict&) { return Follow(); });
}

void bind_pickle(nb::class_<dataset::Instance>& instance) {
    pickled::bind_state(instance, pickled::state_of<dataset::Instance>, [](const nb::dict& state) {
        auto made = pickled::object_of<dataset::Instance>(state);
        if (made.picture.minCoeff() < 0 || made.picture.maxCoeff() > max_image_side)
            throw ArgumentError(
                fmt::format("pickle: Instance: expected a picture of at most {} pixels, got {} x {}",
                            max_image_side, made.picture.x(), made.picture.y()));
        pickled::check(made.visible, made.picture);
        pickled::check(made.amodal, made.picture);
        return made;
    });
}

void bind_pickle(nb::class_<app::Pick>& pick) {
    pickled::bind_state(pick, pickled::state_of<app::Pick>, pickled::object_of<app::Pick>);
}

void refuse_pickle(const char* name) {
    throw nb::type_error(
        fmt::format("a {} cannot be pickled: make one in each process; meshes, cameras, lights and "
                    "view.settings.to_dict() can be pickled",
                    name)
            .c_str());
}

}  // namespace easypbr::python
