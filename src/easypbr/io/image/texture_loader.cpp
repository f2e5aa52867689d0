#include "easypbr/io/image/texture_loader.h"

#include <fmt/format.h>

#include <algorithm>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/io/image/image_io.h"

namespace easypbr::io {

std::string path_from_folder(const std::string& image_path, const fs::path& folder) {
    std::error_code ignored;
    const fs::path relative = fs::proximate(fs::absolute(image_path), folder, ignored);
    return relative.empty() ? image_path : relative.string();
}

fs::path TextureLoader::find(const std::string& name) const {
    std::error_code ignored;
    const fs::path named = folder_ / name;
    const fs::path beside = folder_ / fs::path(name).filename();
    return !fs::exists(named, ignored) && fs::exists(beside, ignored) ? beside : named;
}

Texture TextureLoader::load(std::string name) {
    // Files made on Windows separate folders by backslashes.
    std::replace(name.begin(), name.end(), '\\', '/');
    if (const auto known = textures_.find(name); known != textures_.end()) return known->second;
    Texture texture;
    try {
        const fs::path path = find(name);
        texture.image = std::make_shared<const Image>(load_image(path));
        texture.path = path.string();
    } catch (const Error& error) {
        log_warning(fmt::format("texture left out: {}", error.what()));
    }
    return textures_[name] = texture;
}

}  // namespace easypbr::io
