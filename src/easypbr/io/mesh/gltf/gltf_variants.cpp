#include "easypbr/io/mesh/gltf/gltf_variants.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "easypbr/core/error.h"
#include "easypbr/core/suggest.h"

namespace easypbr::io {

GltfVariants::GltfVariants(const GltfDocument& document, const std::string& chosen) : document_(document) {
    const Json* root = extension(document.root(), khr_variants);
    const Json* list = root ? member(*root, "variants") : nullptr;
    if (list && !list->is_array()) document.fail(fmt::format("{}.variants must be an array", khr_variants));
    for (const Json& variant : list ? *list : Json::array())
        names_.push_back(document.text(variant, "name", fmt::format("variant {}", names_.size())));
    if (!chosen.empty()) choose(chosen);
}

void GltfVariants::choose(const std::string& name) {
    if (names_.empty()) return;
    const std::string path = document_.path().string();
    const auto found = std::ranges::find(names_, name);
    if (found == names_.end())
        throw NameError(fmt::format("{} has no material variant '{}'{}: it has {}", path, name,
                                    did_you_mean(name, names_), fmt::join(names_, ", ")));
    chosen_ = size_t(found - names_.begin());
}

std::optional<size_t> GltfVariants::material_of(const Json& primitive) const {
    const Json* given = chosen_ ? extension(primitive, khr_variants) : nullptr;
    const Json* mappings = given ? member(*given, "mappings") : nullptr;
    if (mappings && !mappings->is_array())
        document_.fail(fmt::format("{}.mappings must be an array", khr_variants));
    for (const Json& mapping : mappings ? *mappings : Json::array()) {
        const std::vector<size_t> variants = document_.integers(mapping, "variants");
        if (std::ranges::find(variants, *chosen_) != variants.end())
            return document_.integer(mapping, "material");
    }
    return document_.optional_integer(primitive, "material");
}

}  // namespace easypbr::io
