// Files that settings and materials name: images, shaders and the environment, read again when they change.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "easypbr/core/image.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/render/pipeline/renderer.h"
#include "easypbr/scene/environment.h"
#include "easypbr/scene/scene.h"

namespace easypbr {
struct Settings;
class NamedFile;
}

namespace easypbr::app {

/// Images of files, as a function of io/image/image_io.h loads them.
class ImageFiles {
  public:
    using Load = Image (*)(const std::filesystem::path&);
    explicit ImageFiles(Load load) : load_(load) {}

    /// Reads those that are new or have changed, all at once. Throws FileError, FormatError.
    void read(const std::vector<NamedFile>& files);
    /// One that has been read; null where no file is named.
    std::shared_ptr<const Image> get(const NamedFile& file) const;

  private:
    struct File {
        std::filesystem::file_time_type time;
        std::shared_ptr<const Image> image;
    };
    Load load_;
    std::map<std::string, File> files_;  ///< by absolute path
};

/// Texts of shaders.
class ShaderTexts {
  public:
    /// The file's text, read when it is new or has changed. Throws FileError.
    const std::string& get(const NamedFile& file);

  private:
    struct File {
        std::filesystem::file_time_type time;
        std::string text;
    };
    std::map<std::string, File> files_;  ///< by absolute path
};

class SettingsFiles {
  public:
    /// Images that the settings name, and the environment, where they are new or have changed. Throws
    /// FileError, FormatError; ArgumentError when the background is an image, and none is named or given.
    void load(const Settings& settings);
    /// The shaders of settings and materials, after load(). Throws FileError.
    void load_shaders(const Settings& settings, const SceneSnapshot& scene);
    /// Reads the environment at once, even if it has been read before.
    void load_environment(const std::filesystem::path& path);
    /// Reads a background image at once, where it is new or has changed. Throws FileError, FormatError.
    void load_background(const std::filesystem::path& path);
    /// The background image where the settings name none; until they name one.
    void set_background(Image image);

    /// What was loaded last.
    const render::SettingsImages& images() const { return images_; }
    /// settings.environment.file's; empty when none is named.
    const Environment& environment() const { return environment_; }

  private:
    /// As it is now.
    bool is_environment_read(const NamedFile& file) const;
    void read_environment(const NamedFile& file);

    ImageFiles image_files_{io::load_image};               ///< textures: as they are stored
    ImageFiles background_files_{io::load_upright_image};  ///< photographs: as they are to be seen
    ShaderTexts shader_texts_;
    render::SettingsImages images_;
    std::string environment_path_;  ///< absolute
    std::filesystem::file_time_type environment_time_;
    Environment environment_;
    std::shared_ptr<const Image> background_;  ///< given as it is
};

}  // namespace easypbr::app
