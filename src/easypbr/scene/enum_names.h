// The names of the enumerations of camera, settings, materials and styles.
#pragma once

#include <string>
#include <vector>

#include "easypbr/scene/field_builder.h"
#include "easypbr/scene/settings.h"

namespace easypbr::detail {

template <>
const std::vector<std::string>& enum_names<Antialias>();
template <>
const std::vector<std::string>& enum_names<Projection>();
template <>
const std::vector<std::string>& enum_names<DistortionModel>();
template <>
const std::vector<std::string>& enum_names<BackgroundMode>();
template <>
const std::vector<std::string>& enum_names<Brdf>();
template <>
const std::vector<std::string>& enum_names<ShadowMode>();
template <>
const std::vector<std::string>& enum_names<SplatDepth>();
template <>
const std::vector<std::string>& enum_names<TransparencyMode>();
template <>
const std::vector<std::string>& enum_names<ToneOperator>();
template <>
const std::vector<std::string>& enum_names<AlphaMode>();
template <>
const std::vector<std::string>& enum_names<DrawMode>();
template <>
const std::vector<std::string>& enum_names<PointShape>();
template <>
const std::vector<std::string>& enum_names<SizeUnit>();
template <>
const std::vector<std::string>& enum_names<ColorBy>();
template <>
const std::vector<std::string>& enum_names<ColorScale>();
template <>
const std::vector<std::string>& enum_names<Corner>();

}  // namespace easypbr::detail
