// The look of an object: what a person may change of how it is drawn, property by property.
#pragma once

#include <string>
#include <vector>

#include "easypbr/scene/fields.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::app {

/// The values of a property: of "style.NAME" that of the style's field, of "material.NAME" (a number or a
/// linear colour of scene/material_table.h) one of each material, of a mesh without any that of the default
/// one. Throws NameError for an unknown property.
std::vector<Value> look_values(const MeshData& data, const std::string& property);
/// Sets values that look_values() gave. Materials beyond them stay, and values beyond the materials are not
/// used. Throws NameError.
void set_look(MeshData& data, const std::string& property, const std::vector<Value>& values);
/// Sets one value, for all materials. Throws NameError, ArgumentError for one that the style does not take.
void set_look(MeshData& data, const std::string& property, const Value& value);

}  // namespace easypbr::app
