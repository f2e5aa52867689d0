#include "easypbr/io/image/texture_loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/io/image/image_io.h"

namespace easypbr::io {

std::string_view unquoted(std::string_view name) {
    if (name.size() > 1 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
    return name;
}

std::string_view without_comment(std::string_view name) {
    size_t end = name.find('#', 1);
    while (end != name.npos && name[end - 1] != ' ' && name[end - 1] != '\t') end = name.find('#', end + 1);
    name = name.substr(0, end);
    const size_t last = name.find_last_not_of(" \t");
    return unquoted(name.substr(0, last == name.npos ? 0 : last + 1));
}

Texture load_texture(const fs::path& path) {
    InputFile file(path);
    Texture texture;
    texture.file_state = file.state();
    const FileBytes bytes(std::move(file));
    texture.image = std::make_shared<const Image>(decode_image(bytes.bytes(), path.string()));
    bytes.check();
    texture.path = fs::absolute(path).string();
    return texture;
}

bool is_in_file(const Texture& texture) {
    if (texture.path.empty() || !texture.image) return !texture.path.empty();
    std::error_code gone;
    const fs::file_time_type time = fs::last_write_time(texture.path, gone);
    const std::uintmax_t size = gone ? 0 : fs::file_size(texture.path, gone);
    return !gone && (!texture.file_state || *texture.file_state == FileState{size, time});
}

std::string path_from_folder(const std::string& image_path, const fs::path& folder) {
    std::error_code ignored;
    const fs::path relative = fs::proximate(fs::absolute(image_path), folder, ignored);
    return relative.empty() ? image_path : relative.string();
}

namespace {

/// Files made on Windows separate folders by backslashes.
std::string with_slashes(std::string name) {
    std::ranges::replace(name, '\\', '/');
    return name;
}

/// "./a" is "a": the folder of the file is that which was given.
std::string without_dot(std::string name) {
    while (name.starts_with("./")) name.erase(0, 2);
    return name;
}

/// Whoever watches the files learns of one that is missing.
void note_missing(const fs::path& path) {
    try {
        const InputFile missing(path);
    } catch (const FileError&) {
    }
}

}  // namespace

std::optional<fs::path> find_named_file(const std::vector<fs::path>& folders, const std::string& name) {
    const std::string separated = without_dot(with_slashes(name));
    for (const fs::path& given :
         {fs::path(without_dot(name)), fs::path(separated), fs::path(separated).filename()})
        for (const fs::path& folder : folders)
            if (exists_in_scope(folder / given)) return folder / given;
    const std::string plain(without_comment(name));
    return plain == name ? std::nullopt : find_named_file(folders, plain);
}

fs::path place_of_named_file(const fs::path& folder, const std::string& name) {
    return folder / without_dot(with_slashes(std::string(without_comment(name))));
}

Texture TextureLoader::load(const std::string& name, const fs::path& first) {
    std::vector<fs::path> folders{first};
    if (first != folder_) folders.push_back(folder_);
    const std::optional<fs::path> found = find_named_file(folders, name);
    const fs::path path = found ? *found : place_of_named_file(first, name);
    if (const auto known = textures_.find(path.string()); known != textures_.end()) return known->second;
    if (!found && folders.size() > 1) note_missing(place_of_named_file(folder_, name));
    Texture texture;
    try {
        texture = load_texture(path);
    } catch (const Error& error) {
        log_warning(fmt::format("texture left out: {}", error.what()));
    }
    return textures_[path.string()] = texture;
}

}  // namespace easypbr::io
