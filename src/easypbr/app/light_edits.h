// What a person does to a scene's lights, whatever panels show them.
#pragma once

#include <optional>
#include <string>

#include "easypbr/app/live_drawing.h"
#include "easypbr/scene/light_table.h"

namespace easypbr::app {

/// Adds a light at half the view's distance beside, above and before the target, as bright there as 3 lux,
/// and selects it.
void add_light(LiveDrawing& live);
void change_light(LiveDrawing& live, const std::string& name, const Light& light);
/// Nobody has it selected afterwards.
void remove_light(LiveDrawing& live, const std::string& name);

/// A light's field as a person is shown it: colours are sRGB.
FieldInfo shown_field(const LightField& field);
Value shown_value(const LightField& field, const Light& light);
/// `shown`: a checked value of shown_field(). A direction without length is not taken.
void put_shown(const LightField& field, Light& light, const Value& shown);
/// What is in force where the field is automatic; none where that is not known yet.
std::optional<Value> inferred_value(const LiveDrawing& live, const std::string& light,
                                    const LightField& field);

}  // namespace easypbr::app
