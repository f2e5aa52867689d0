// Layers as pictures for the eye, and the slices of the G-buffer side by side.
#pragma once

#include <string>
#include <vector>

#include "easypbr/core/image.h"

namespace easypbr::app {

/// What a live view can show: "picture", "slices", and all layers.
std::vector<std::string> channel_names();
/// Whether it is a layer.
bool is_layer(const std::string& channel);

/// A layer (see render::Layer) as an RGBA u8 picture: colours encoded as sRGB, normals as n / 2 + 1/2, depth
/// by colormap over what occurs (near is bright), ids and elements in colours of their own, all of these grey
/// where there is nothing; other numbers as grey values from 0 to 1.
Image layer_picture(const std::string& name, const Image& layer);

/// Pictures of one size side by side in slanted slices, first at the left, divided by thin lines (the figure
/// of the G-buffer in the paper). Throws ArgumentError when there is none or the sizes differ.
Image slices(const std::vector<Image>& pictures);

}  // namespace easypbr::app
