// What Python holds of a mesh's material and style: their place in the mesh, or a value of their own.
#pragma once

#include <optional>

#include "easypbr/python/bindings.h"
#include "easypbr/scene/material_table.h"
#include "easypbr/scene/mesh.h"

namespace easypbr::python {

struct MaterialHandle {
    std::optional<Mesh> mesh;
    int index = 0;
    Material own;

    Material get() const { return mesh ? mesh->material(index) : own; }

    template <class Change>
    void change(Change&& change) {
        if (!mesh) {
            Material changed = own;
            change(changed);
            validate(changed);
            own = std::move(changed);
            return;
        }
        released([&] {
            mesh->edit([&](MeshData& data) {
                if (data.materials.empty()) data.materials.emplace_back();
                change(data.materials.at(size_t(index)));
            });
        });
    }
};

struct LabelMapHandle {
    std::shared_ptr<const LabelMap> map;
};

/// A LabelMap, a built-in map's name or a path; null for None. Throws ArgumentError, NameError and what
/// io::find_label_map() throws.
std::shared_ptr<const LabelMap> to_label_map(nb::handle object);

struct StyleHandle {
    std::optional<Mesh> mesh;
    Style own;

    Style get() const { return mesh ? mesh->style() : own; }

    template <class Change>
    void change(Change&& change) {
        if (!mesh) return change(own);
        released([&] { mesh->edit([&](MeshData& data) { change(data.style); }); });
    }
};

}  // namespace easypbr::python
