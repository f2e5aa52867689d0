#include "easypbr/scene/enum_names.h"

namespace easypbr::detail {

template <>
const std::vector<std::string>& enum_names<Antialias>() {
    static const std::vector<std::string> names = {"none", "fxaa"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<Projection>() {
    static const std::vector<std::string> names = {"perspective", "orthographic"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<DistortionModel>() {
    static const std::vector<std::string> names = {"brown_conrady", "fisheye"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<BackgroundMode>() {
    static const std::vector<std::string> names = {"color", "environment", "blur", "image", "transparent"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<Brdf>() {
    static const std::vector<std::string> names = {"height_correlated", "separable", "ue4"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<ShadowMode>() {
    static const std::vector<std::string> names = {"hard", "pcf", "soft"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<SplatDepth>() {
    static const std::vector<std::string> names = {"median", "expected"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<TransparencyMode>() {
    static const std::vector<std::string> names = {"layers", "stochastic"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<ToneOperator>() {
    static const std::vector<std::string> names = {"aces", "reinhard", "agx", "neutral", "none"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<AlphaMode>() {
    static const std::vector<std::string> names = {"opaque", "mask", "blend"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<PointShape>() {
    static const std::vector<std::string> names = {"round", "square"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<SizeUnit>() {
    static const std::vector<std::string> names = {"pixels", "world"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<ColorBy>() {
    static const std::vector<std::string> names = {"solid",  "vertex", "texture", "label",    "scalar",
                                                   "height", "normal", "uv",      "intensity"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<ColorScale>() {
    static const std::vector<std::string> names = {"linear", "log"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<Corner>() {
    static const std::vector<std::string> names = {"top_left", "top_right", "bottom_left", "bottom_right"};
    return names;
}

}  // namespace easypbr::detail
