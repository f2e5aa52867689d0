#include "easypbr/io/mesh/gltf/gltf_used_rows.h"

#include <algorithm>
#include <map>
#include <optional>

#include "easypbr/core/parallel.h"

namespace easypbr::io {
namespace {

/// Rows for each index from which on the indices are sorted, in place of a mark for each row.
constexpr size_t rows_per_index = 16;
constexpr size_t renumbered_grain = 1 << 15;

/// Accessors of indices by those of positions; none where a primitive has all rows.
using IndicesByPosition = std::map<size_t, std::set<std::optional<size_t>>>;

std::optional<size_t> accessor_in(const Json& object, const char* name) {
    const Json* value = object.is_object() ? member(object, name) : nullptr;
    if (!value || !value->is_number_unsigned()) return {};
    return value->get<size_t>();
}

IndicesByPosition indices_by_position(const Json& mesh) {
    IndicesByPosition used;
    const Json* primitives = mesh.is_object() ? member(mesh, "primitives") : nullptr;
    if (!primitives || !primitives->is_array()) return used;
    for (const Json& primitive : *primitives) {
        const Json* attributes = primitive.is_object() ? member(primitive, "attributes") : nullptr;
        if (const auto position = attributes ? accessor_in(*attributes, "POSITION") : std::nullopt)
            used[*position].insert(accessor_in(primitive, "indices"));
    }
    return used;
}

}  // namespace

std::set<size_t> gltf_shared_positions(const GltfDocument& document) {
    IndicesByPosition first_uses;
    std::set<size_t> shared;
    const Json* meshes = member(document.root(), "meshes");
    if (!meshes || !meshes->is_array()) return shared;
    for (const Json& mesh : *meshes)
        for (const auto& [position, indices] : indices_by_position(mesh))
            if (first_uses.try_emplace(position, indices).first->second != indices) shared.insert(position);
    return shared;
}

GltfUsedRows::GltfUsedRows(size_t count, std::span<const std::vector<uint32_t>* const> lists) {
    size_t index_count = 0;
    for (const std::vector<uint32_t>* list : lists) {
        if (!list) uses_all_ = true;
        index_count += list ? list->size() : 0;
    }
    if (uses_all_) return;
    if (index_count < count / rows_per_index)
        list_named(lists, index_count);
    else
        mark_named(count, lists);
}

void GltfUsedRows::list_named(std::span<const std::vector<uint32_t>* const> lists, size_t index_count) {
    rows_.reserve(index_count);
    for (const std::vector<uint32_t>* list : lists) rows_.insert(rows_.end(), list->begin(), list->end());
    std::ranges::sort(rows_);
    rows_.erase(std::unique(rows_.begin(), rows_.end()), rows_.end());
}

void GltfUsedRows::mark_named(size_t count, std::span<const std::vector<uint32_t>* const> lists) {
    std::vector<char> marks(count, 0);
    for (const std::vector<uint32_t>* list : lists)
        for (const uint32_t index : *list) marks[index] = 1;
    const auto used = size_t(std::ranges::count(marks, 1));
    uses_all_ = used == count;
    if (uses_all_) return;
    rows_.reserve(used);
    places_.resize(count);
    for (size_t row = 0; row < count; ++row) {
        places_[row] = uint32_t(rows_.size());
        if (marks[row]) rows_.push_back(int32_t(row));
    }
}

void GltfUsedRows::renumber(std::vector<uint32_t>& indices) const {
    if (uses_all_) return;
    parallel_for(indices.size(), renumbered_grain, [&](size_t i) {
        uint32_t& index = indices[i];
        index = places_.empty() ? uint32_t(std::ranges::lower_bound(rows_, int32_t(index)) - rows_.begin())
                                : places_[index];
    });
}

}  // namespace easypbr::io
