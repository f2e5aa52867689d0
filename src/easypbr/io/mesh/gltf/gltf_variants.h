// Variants of a file: a material for each primitive, by name (KHR_materials_variants).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "easypbr/io/mesh/gltf/gltf_document.h"

namespace easypbr::io {

inline constexpr const char* khr_variants = "KHR_materials_variants";

class GltfVariants {
  public:
    /// `chosen`: the name of a variant; empty: none. A file without variants has its own materials, with a
    /// warning when one is chosen. Throws NameError, with the nearest name, for one that the file lacks.
    GltfVariants(const GltfDocument& document, const std::string& chosen);

    const std::vector<std::string>& names() const { return names_; }
    /// The material of a primitive; nothing: the default one. Throws FormatError.
    std::optional<size_t> material_of(const Json& primitive) const;

  private:
    void choose(const std::string& name);

    const GltfDocument& document_;
    std::vector<std::string> names_;
    std::optional<size_t> chosen_;
};

}  // namespace easypbr::io
