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

fs::path TextureLoader::find(const std::string& name) const {
    // Files made on Windows separate folders by backslashes.
    std::string separated = name;
    std::replace(separated.begin(), separated.end(), '\\', '/');
    std::error_code ignored;
    for (const std::string& given : {name, separated})
        for (const fs::path& path : {folder_ / given, folder_ / fs::path(given).filename()})
            if (fs::exists(path, ignored)) return path;
    const std::string plain(without_comment(name));
    return plain == name ? folder_ / separated : find(plain);
}

Texture TextureLoader::load(const std::string& name) {
    const fs::path path = find(name);
    if (const auto known = textures_.find(path.string()); known != textures_.end()) return known->second;
    Texture texture;
    try {
        texture = load_texture(path);
    } catch (const Error& error) {
        log_warning(fmt::format("texture left out: {}", error.what()));
    }
    return textures_[path.string()] = texture;
}

}  // namespace easypbr::io
