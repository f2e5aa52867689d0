#include "easypbr/python/pickle.h"

#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/io/settings/camera_path_io.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/text.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/light_table.h"
#include "easypbr/scene/material_table.h"

namespace easypbr::python {
namespace {

constexpr std::string_view style_prefix = "style.";

template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_same_v<T, std::string> ||
    std::is_same_v<T, std::filesystem::path> || std::is_same_v<T, std::array<double, 8>>;

/// Members of an object as a dict, by their names. What is none, empty or automatic is left out.
class Saved {
  public:
    /// Images and label maps that several members share are kept once.
    using Shared = std::map<const void*, nb::object>;

    explicit Saved(Shared& shared) : shared_(&shared) {}
    const nb::dict& state() const { return state_; }

    template <class T>
    void operator()(const char* name, const T& value) {
        const nb::object object = object_of(value);
        if (!object.is_none()) state_[name] = object;
    }
    template <class Enum>
    void choice(const char* name, Enum value, int /*count*/) {
        state_[name] = int(value);
    }

  private:
    template <Plain T>
    nb::object object_of(const T& value) {
        return nb::cast(value);
    }
    nb::object object_of(const std::array<double, 8>& values) {
        return nb::cast(std::vector<double>(values.begin(), values.end()));
    }
    template <class Scalar, int Rows, int Cols>
    requires(Rows > 0 && Cols > 0) nb::object object_of(const Eigen::Matrix<Scalar, Rows, Cols>& matrix) {
        return nb::cast(std::vector<double>(matrix.data(), matrix.data() + matrix.size()));
    }
    template <class Scalar, int Cols>
    nb::object object_of(const Array<Scalar, Cols>& array) {
        if (array.empty()) return nb::none();
        return view_of(array).attr("view")(nb::module_::import_("numpy").attr("ndarray"));
    }
    nb::object object_of(const std::shared_ptr<const Image>& image) {
        if (!image) return nb::none();
        return shared(image.get(), [&] { return to_numpy(image); });
    }
    nb::object object_of(const std::shared_ptr<const LabelMap>& map) {
        if (!map) return nb::none();
        return shared(map.get(), [&] { return nb::cast(LabelMapHandle{map}); });
    }
    nb::object object_of(const Style& style);
    nb::object object_of(const MeshList& children);
    template <class T>
    nb::object object_of(const std::optional<T>& value) {
        return value ? object_of(*value) : nb::none();
    }
    template <class T>
    nb::object object_of(const std::vector<T>& values) {
        nb::list list;
        for (const T& value : values) list.append(object_of(value));
        return list.size() ? nb::object(list) : nb::none();
    }
    template <class T>
    nb::object object_of(const T& value) {
        Saved members(*shared_);
        exchange(members, value);
        return members.state();
    }

    template <class Make>
    nb::object shared(const void* key, Make&& make) {
        nb::object& object = (*shared_)[key];
        if (!object.is_valid()) object = make();
        return object;
    }

    Shared* shared_;
    nb::dict state_;
};

/// The reverse. Members that the dict lacks stay as they are.
class Loaded {
  public:
    using Shared = std::map<PyObject*, std::shared_ptr<const void>>;

    Loaded(const nb::dict& state, Shared& shared) : state_(state), shared_(&shared) {}

    template <class T>
    void operator()(const char* name, T& value) {
        if (const nb::object object = take(name); object.is_valid()) load(object, value, name);
    }
    template <class Enum>
    void choice(const char* name, Enum& value, int count) {
        const nb::object object = take(name);
        if (!object.is_valid()) return;
        const int index = nb::cast<int>(object);
        if (index < 0 || index >= count)
            throw ArgumentError(fmt::format("pickle: {}: expected 0 to {}, got {}", name, count - 1, index));
        value = Enum(index);
    }
    /// Throws ArgumentError when the dict has members that were not asked for.
    void finish() const {
        if (left_.size())
            throw ArgumentError(
                fmt::format("pickle: '{}' is not known: it was written by a newer version of easypbr",
                            nb::cast<std::string>(nb::str(*left_.begin()))));
    }

  private:
    nb::object take(const char* name) {
        if (!state_.contains(name)) return {};
        left_.attr("discard")(name);
        return nb::borrow(state_[name]);
    }

    template <Plain T>
    void load(const nb::object& object, T& value, const char*) {
        value = nb::cast<T>(object);
    }
    void load(const nb::object& object, std::array<double, 8>& values, const char* name) {
        std::ranges::copy(numbers<8>(object, name), values.begin());
    }
    template <class Scalar, int Rows, int Cols>
    requires(Rows > 0 && Cols > 0) void load(const nb::object& object,
                                             Eigen::Matrix<Scalar, Rows, Cols>& matrix, const char* name) {
        const auto values = numbers<size_t(Rows * Cols)>(object, name);
        for (int i = 0; i < Rows * Cols; ++i) matrix.data()[i] = Scalar(values[size_t(i)]);
    }
    template <class Scalar, int Cols>
    void load(const nb::object& object, Array<Scalar, Cols>& array, const char* name) {
        const nb::object shape = object.attr("shape");
        const int given = nb::len(shape) > 1 ? nb::cast<int>(shape[1]) : 1;
        const int columns = Cols == Eigen::Dynamic ? given : Cols;
        array = to_array<Scalar, Cols>(object, {name, columns, columns});
    }
    void load(const nb::object& object, std::shared_ptr<const Image>& image, const char* name) {
        image = shared<Image>(object, [&] { return std::make_shared<const Image>(to_image(object, name)); });
    }
    void load(const nb::object& object, std::shared_ptr<const LabelMap>& map, const char*) {
        map = nb::cast<const LabelMapHandle&>(object).map;
    }
    void load(const nb::object& object, Style& style, const char* name);
    void load(const nb::object& object, MeshList& children, const char* name);
    template <class T>
    void load(const nb::object& object, std::optional<T>& value, const char* name) {
        load(object, value.emplace(), name);
    }
    template <class T>
    void load(const nb::object& object, std::vector<T>& values, const char* name) {
        values.clear();
        for (nb::handle item : object) load(nb::borrow(item), values.emplace_back(), name);
    }
    template <class T>
    void load(const nb::object& object, T& value, const char*) {
        Loaded members(nb::cast<nb::dict>(object), *shared_);
        exchange(members, value);
        members.finish();
    }

    template <size_t count>
    static std::vector<double> numbers(const nb::object& object, const char* name) {
        auto values = nb::cast<std::vector<double>>(object);
        if (values.size() != count)
            throw ArgumentError(
                fmt::format("pickle: {}: expected {} numbers, got {}", name, count, values.size()));
        return values;
    }
    template <class T, class Make>
    std::shared_ptr<const T> shared(const nb::object& object, Make&& make) {
        std::shared_ptr<const void>& kept = (*shared_)[object.ptr()];
        if (!kept) kept = make();
        return std::static_pointer_cast<const T>(kept);
    }

    nb::dict state_;
    nb::set left_{state_};
    Shared* shared_;
};

// What objects consist of, for both directions: they are const where they are saved.

template <class Object, class T>
concept Is = std::is_same_v<std::remove_const_t<Object>, T>;

template <class Archive, Is<Texture> Object>
void exchange(Archive& archive, Object& texture) {
    archive("image", texture.image);
    archive("path", texture.path);
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
    if constexpr (std::is_const_v<Object>) {
        if (mesh.rest_shape.F_revision == mesh.F.revision()) archive("rest_V", mesh.rest_shape.V);
    } else {
        archive("rest_V", mesh.rest_shape.V);
        mesh.rest_shape.F_revision = mesh.F.revision();
    }
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

}  // namespace

void bind_pickle(nb::class_<Mesh>& mesh) {
    bind_state(
        mesh, [](const Mesh& m) { return state_of(*m.snapshot()); },
        [](const nb::dict& state) {
            auto data = object_of<MeshData>(state);
            return released([&] { return Mesh(std::move(data)); });
        });
}

void bind_pickle(nb::class_<MaterialHandle>& material) {
    bind_state(
        material, [](const MaterialHandle& m) { return state_of(m.get()); },
        [](const nb::dict& state) {
            MaterialHandle handle{{}, 0, object_of<Material>(state)};
            validate(handle.own);
            return handle;
        });
}

void bind_pickle(nb::class_<StyleHandle>& style) {
    bind_state(
        style, [](const StyleHandle& s) { return style_state(s.get()); },
        [](const nb::dict& state) {
            return StyleHandle{{}, style_of(state)};
        });
}

void bind_pickle(nb::class_<Camera>& camera) {
    bind_state(camera, state_of<Camera>, object_of<Camera>);
}

void bind_pickle(nb::class_<CameraPath>& path) {
    bind_state(
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
    bind_state(
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
    bind_state(
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
    bind_state(
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
    bind_state(
        follow, [](const Follow&) { return nb::dict(); }, [](const nb::dict&) { return Follow(); });
}

void refuse_pickle(const char* name) {
    throw nb::type_error(
        fmt::format("a {} cannot be pickled: make one in each process; meshes, cameras, lights and "
                    "view.settings.to_dict() can be pickled",
                    name)
            .c_str());
}

}  // namespace easypbr::python
