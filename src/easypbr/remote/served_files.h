// ServedFiles: the files beneath a folder that clients may look through and have opened.
#pragma once

#include <atomic>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "easypbr/core/folder.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/environment.h"

namespace easypbr::remote {

/// Clients choose among the names that are listed. Files are read on a thread of their own; what they name,
/// such as textures, is read beneath the folder only. Used by the thread of Views alone.
class ServedFiles {
  public:
    /// Throws FileError when there is no such folder.
    explicit ServedFiles(const std::filesystem::path& folder);
    /// Gives up what is being read.
    ~ServedFiles();
    ServedFiles(const ServedFiles&) = delete;
    ServedFiles& operator=(const ServedFiles&) = delete;

    /// Where clients are: relative to the folder, which is empty.
    const std::filesystem::path& place() const { return place_; }
    /// Folders, and files that can be opened, at place(): as they were at most some seconds ago. Throws
    /// FileError.
    const std::vector<FolderEntry>& entries();
    /// Goes into one of the folders in place(), and out of it. entries() is read anew.
    void enter(const std::string& name);
    void leave();

    /// Begins to read one of the files in place(), instead of what is being read.
    void open(const std::string& name, const io::LoadOptions& options);
    /// What is being read; empty: nothing.
    std::string reading() const;
    void stop();

    /// A picture with high range is an environment.
    struct Opened {
        std::filesystem::path path;
        std::variant<io::LoadedScene, Environment> content;
    };
    /// What has been read, once. Throws what reading threw.
    std::optional<Opened> take();

    /// Names under which clients have had files shown.
    std::vector<std::string> shown;
    bool adds = false;   ///< the next file is shown beside those, else in their place
    std::string search;  ///< a part of the names that are listed

  private:
    struct Job;

    Folder folder_;
    std::filesystem::path place_;
    std::vector<FolderEntry> entries_;
    double listed_s_ = -1;
    std::unique_ptr<Job> job_;
};

}  // namespace easypbr::remote
