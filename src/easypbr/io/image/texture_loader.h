// Images that mesh files name, read once each; what cannot be read is a warning, not an error.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "easypbr/core/file.h"
#include "easypbr/core/image.h"
#include "easypbr/scene/material.h"

namespace easypbr::io {

/// A name in a text file without quotes around it.
std::string_view unquoted(std::string_view name);
/// The same, first without a comment: '#' behind a blank and all that follows.
std::string_view without_comment(std::string_view name);

/// The file that is named in a text: in the first of the folders that has it under its path, else under its
/// bare name; backslashes may separate folders, and where there is no such file, without_comment() is tried.
/// None: it is missing. Nothing outside of the folder of a FolderScope is found.
std::optional<fs::path> find_named_file(const std::vector<fs::path>& folders, const std::string& name);

/// Where such a file would be in a folder.
fs::path place_of_named_file(const fs::path& folder, const std::string& name);

/// The image in a file as a texture with an absolute path. Throws FileError, FormatError; messages name the
/// path as it was given.
Texture load_texture(const fs::path& path);

/// Whether the file at a texture's path holds its image: it is there and, where that is known, as it was when
/// the image was read. Of a texture without an image: it has a path.
bool is_in_file(const Texture& texture);

/// How a mesh file in `folder` (absolute) refers to the image at `image_path`.
std::string path_from_folder(const std::string& image_path, const fs::path& folder);

/// Loads the images named in one mesh file.
class TextureLoader {
  public:
    /// `mesh_file`: names are relative to its folder.
    explicit TextureLoader(const fs::path& mesh_file) : folder_(mesh_file.parent_path()) {}

    /// A texture with the named image, as find_named_file() finds it in the mesh file's folder. Empty, with a
    /// warning in the log, when it is missing or damaged.
    Texture load(const std::string& name) { return load(name, folder_); }
    /// The same where a file in `first` has the name: that folder comes before the mesh file's.
    Texture load(const std::string& name, const fs::path& first);

  private:
    fs::path folder_;
    std::map<std::string, Texture> textures_;  ///< by path
};

}  // namespace easypbr::io
