#include "easypbr/io/mesh/gltf/gltf_draco.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "easypbr/io/mesh/gltf/draco/module.h"
#include "easypbr/io/mesh/gltf/gltf_accessor.h"
#include "easypbr/io/source/module_loader.h"

namespace easypbr::io {
namespace {

constexpr const char* draco_file = "libeasypbr_draco.so";
constexpr size_t draco_mode = 4;  ///< triangles

struct DracoModule : RuntimeModule {
    DracoModule() : RuntimeModule(draco_file) { find(decode, "easypbr_draco_decode"); }

    decltype(&easypbr_draco_decode) decode = nullptr;
};

const DracoModule& draco_module() {
    static const DracoModule loaded;
    return loaded;
}

class DracoPrimitive {
  public:
    DracoPrimitive(GltfDocument& document, const Json& json, const Json& packed, const std::string& owner)
        : document_(document), json_(json), packed_(packed), owner_(owner) {}

    void unpack() {
        if (!draco_problem().empty())
            fail(fmt::format(
                "its module cannot be loaded ({}): install the package libdraco7 and keep {} beside "
                "libeasypbr.so, or save the file without compression",
                draco_problem(), draco_file));
        if (document_.optional_integer(json_, "mode").value_or(draco_mode) != draco_mode)
            fail("expected a primitive of triangles");
        const size_t view = document_.integer(packed_, "bufferView");
        const size_t indices = document_.integer(json_, "indices");
        list_attributes();
        std::string error;
        draco_module().decode(document_.buffer_view(view), mesh_, error);
        if (!error.empty()) fail(fmt::format("bufferViews[{}] is damaged: {}", view, error));
        std::map<size_t, std::vector<std::byte>> rows;
        for (size_t i = 0; i < accessors_.size(); ++i)
            rows[accessors_[i]] = std::move(mesh_.attributes[i].rows);
        rows[indices] = rows_of_indices(indices);
        document_.provide(std::move(rows));
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        document_.fail(fmt::format("{}, {}: {}", owner_, khr_draco, what));
    }

    /// What is asked of the compressed data, as its accessors describe it.
    void list_attributes() {
        const Json* compressed = member(packed_, "attributes");
        if (!compressed || !compressed->is_object()) fail("there are no attributes");
        for (const auto& [name, value] : compressed->items()) {
            const size_t accessor = document_.integer(json_.at("attributes"), name.c_str());
            const GltfRows rows = gltf_rows(document_, accessor);
            const size_t id = document_.integer(*compressed, name.c_str());
            if (id > std::numeric_limits<uint32_t>::max() || rows.components > 4)
                fail(fmt::format("{} cannot be compressed", name));
            mesh_.attributes.push_back({uint32_t(id), rows.component_type, rows.components, {}});
            accessors_.push_back(accessor);
        }
    }

    template <class T>
    static std::vector<std::byte> bytes_of(const std::vector<uint32_t>& indices) {
        const std::vector<T> narrow(indices.begin(), indices.end());
        const auto bytes = std::as_bytes(std::span(narrow));
        return {bytes.begin(), bytes.end()};
    }

    /// The accessor's type may be too narrow for what it is given.
    std::vector<std::byte> rows_of_indices(size_t accessor) const {
        const size_t type = gltf_rows(document_, accessor).component_type;
        const uint32_t most = type == 5121   ? std::numeric_limits<uint8_t>::max()
                              : type == 5123 ? std::numeric_limits<uint16_t>::max()
                                             : std::numeric_limits<uint32_t>::max();
        const bool fits = std::ranges::all_of(mesh_.indices, [&](uint32_t index) { return index <= most; });
        if (!fits) fail(fmt::format("accessors[{}] has a type that is too narrow for its indices", accessor));
        return type == 5121   ? bytes_of<uint8_t>(mesh_.indices)
               : type == 5123 ? bytes_of<uint16_t>(mesh_.indices)
                              : bytes_of<uint32_t>(mesh_.indices);
    }

    GltfDocument& document_;
    const Json &json_, &packed_;
    const std::string& owner_;
    DracoMesh mesh_;
    std::vector<size_t> accessors_;
};

}  // namespace

const std::string& draco_problem() {
    return draco_module().reason();
}

std::optional<size_t> unpack_draco(GltfDocument& document, const Json& primitive, const std::string& owner) {
    document.provide({});
    const Json* packed = extension(primitive, khr_draco);
    if (!packed) return std::nullopt;
    // What is there without compression too is read from there.
    const size_t position = document.integer(primitive.at("attributes"), "POSITION");
    if (member(document.item("accessors", position), "bufferView")) return std::nullopt;
    DracoPrimitive(document, primitive, *packed, owner).unpack();
    return document.integer(*packed, "bufferView");
}

}  // namespace easypbr::io
