// Ground truth as files: what Viewer.render_layers() gives in Python, for `easypbr render --layers`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "easypbr/app/session.h"

namespace easypbr::cli {

/// What `easypbr render --layers` takes: the ground truth but for the picture itself and flow, which needs
/// another frame, the picture's own layers, and "instances".
std::vector<std::string> writable_layers();

/// Throws UsageError for what is neither a layer of the picture, one of the ground truth, nor "instances",
/// and for flow, which needs another frame.
void check_layer(const std::string& name);

/// Those of the names that the picture's own layers do not have.
std::vector<std::string> truth_layers_of(const std::vector<std::string>& names);

/// Where a layer of a picture is written: OUT_LAYER.exr, instances as OUT_instances.json.
std::filesystem::path truth_path(const std::filesystem::path& picture, const std::string& layer);

/// Writes each beside the picture: EXR of float32 (two channels are followed by an empty third), of integers
/// as UINT (see io::encode_exr), instances as a list in JSON. Throws what dataset::ground_truth() throws, and
/// FileError.
void write_truth(app::Session& session, const std::filesystem::path& picture,
                 const std::vector<std::string>& layers);

}  // namespace easypbr::cli
