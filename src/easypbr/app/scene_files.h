// Files that a person brings into a session while looking at it, and watches.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "easypbr/app/animation_player.h"
#include "easypbr/app/edits.h"
#include "easypbr/app/notifications.h"
#include "easypbr/app/session.h"
#include "easypbr/scene/light.h"

namespace easypbr::io {
struct LoadedScene;
struct LoadOptions;
}  // namespace easypbr::io

namespace easypbr::app {

/// How the settings say that mesh files are read; `format` is an extension, empty: the file's own.
io::LoadOptions load_options(const Settings& settings, const std::string& format = {});

/// Tells by notifications what it has done.
class SceneFiles {
  public:
    /// All must outlive it.
    SceneFiles(Session& session, AnimationPlayer& player, Notifications& notifications, Edits& edits)
        : session_(session), player_(player), notifications_(notifications), edits_(edits) {}

    /// Adds what a file holds under the file's name, made unique; pictures with high range become the
    /// environment. Throws FileError, FormatError.
    void open(const std::filesystem::path& path);
    /// Adds what was read from a file, and returns the name that it has in the scene.
    std::string add(const io::LoadedScene& loaded, const std::filesystem::path& path);
    /// Removes what a file's name stands for in the scene, with its lights and animations. Nothing happens
    /// when it is not there.
    void close(const std::string& name);

    /// Shows the file again under `name` whenever it, or a file that was read with it (LoadedScene::files),
    /// changes after it was read, while the scene has the name. `loaded` is what load_scene() gave for it,
    /// and `format` that of its options. What a person has changed or removed by hand stays so, see Edits; a
    /// light that is the same in the file stays as the program has it.
    void watch(const std::filesystem::path& path, const std::string& name, const io::LoadedScene& loaded,
               const std::string& format = {});
    /// Lets time pass: looks now and then whether watched files have changed. Errors become notifications.
    void advance(double seconds);

    /// Writes the settings for pictures of this size, with the hashes of the files that are shown. The
    /// notification is the command that draws the picture again, and what the file does not hold. Throws as
    /// app::save_settings().
    void save_settings(const std::filesystem::path& path, Vec2i size);

  private:
    struct Watched {
        std::filesystem::path path;
        std::string name;
        std::string format;  ///< as LoadOptions::format
        std::map<std::filesystem::path, std::filesystem::file_time_type>
            times;                            ///< of all that were read, when they were
        std::map<std::string, Light> lights;  ///< of the file, by its own names
        bool is_animated = false;
    };
    /// The files that are shown, in the order of the scene.
    std::vector<std::filesystem::path> sources() const;
    /// What is seen and no settings hold, in words.
    std::vector<std::string> unsaved() const;
    /// Looks from now on at the files that were read.
    static void follow(Watched& watched, const io::LoadedScene& loaded);
    void show(const io::LoadedScene& loaded, const std::string& name);
    /// From the lights that the file had to those that it has now.
    void change_lights(const Watched& from, const io::LoadedScene& to);
    /// Looks at the files that it names even if they cannot be read. Throws as load_scene().
    io::LoadedScene read_again(Watched& file);
    void reload(Watched& file);

    Session& session_;
    AnimationPlayer& player_;
    Notifications& notifications_;
    Edits& edits_;
    std::vector<Watched> watched_;
    double since_watch_ = 0;
};

}  // namespace easypbr::app
