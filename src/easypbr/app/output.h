// Pictures to files: which encoding a file takes, and settings beside them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "easypbr/app/session.h"

namespace easypbr::app {

/// What a file of this extension holds: scene_linear for HDR and EXR, srgb16 for PNG when `deep`, else srgb8.
/// Throws ArgumentError for an extension that cannot be written, and for one that is not PNG when `deep`.
Encoding encoding_for(const std::filesystem::path& path, bool deep = false);

/// Throws ArgumentError when a picture is larger than a file of this extension holds.
void check_picture_fits(const std::filesystem::path& path, Vec2i size);

/// Throws ArgumentError when a file of this extension cannot hold a transparent background.
void check_holds_alpha(const std::filesystem::path& path);

/// Throws, before anything is drawn, when the picture cannot be written there: FileError, or ArgumentError
/// for an unknown extension, a size that the format does not hold (none: the settings') and a transparent
/// JPEG or HDR.
void check_picture(const std::filesystem::path& path, const Settings& settings,
                   std::optional<Vec2i> size = std::nullopt);

/// "OUT_depth.exr" next to "OUT.png".
std::filesystem::path layer_path(const std::filesystem::path& picture, const std::string& layer);

/// Draws and writes one picture. The target is checked before anything is drawn; it appears whole or not at
/// all. Returns the path. Throws FileError, ArgumentError, ContextError.
std::filesystem::path render_to_file(Session& session, const std::filesystem::path& path,
                                     const PictureOptions& options = {}, bool deep = false);

/// Writes "OUT_depth.exr" and so on next to `path`, one file per layer; returns their paths.
std::vector<std::filesystem::path> layers_to_files(Session& session, const std::filesystem::path& path,
                                                   const std::vector<std::string>& layers,
                                                   std::optional<Vec2i> size = std::nullopt);

/// Every value, chosen and inferred, of the last picture, with the hashes of the files it was made from.
/// `size`: that of the picture; none: the settings'. Throws ArgumentError where the settings name a file, or
/// the scene has a light, whose name is not UTF-8; of `files` such are left out, with a warning. Throws
/// FileError.
void save_settings(const Session& session, const std::vector<std::filesystem::path>& files,
                   const std::filesystem::path& path, std::optional<Vec2i> size = std::nullopt);

/// Takes over settings and lights from a file that save_settings() wrote. Files with another content than
/// then are reported as warnings.
void load_settings(Session& session, const std::filesystem::path& path);

/// Sets what a settings file says; the rest stays. Throws FileError, FormatError, NameError.
void apply_settings(Session& session, const std::filesystem::path& path);

/// The same for a preset, a built-in one's name (io/settings/presets.h) or a settings file. What was inferred
/// is inferred anew, but for the camera.
void apply_preset(Session& session, const std::string& name_or_path);

}  // namespace easypbr::app
