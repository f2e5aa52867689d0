// Folder: a folder beneath which files are opened, and nothing outside of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "easypbr/core/file.h"

namespace easypbr {

/// What stands in a folder. Names that are hidden (".git") or no UTF-8, and links that lead out, are not
/// entries.
struct FolderEntry {
    std::string name;
    bool is_folder = false;
    uint64_t bytes = 0;  ///< of a file
    bool operator==(const FolderEntry&) const = default;
};

/// Stays the folder that it was when it was opened, even where another one is put into its place.
class Folder {
  public:
    /// Throws FileError when there is no such folder, or when it cannot be read.
    explicit Folder(const fs::path& path);

    /// Absolute.
    const fs::path& path() const { return path_; }

    /// Opens what has a name relative to the folder. -1, and errno EXDEV, for what lies outside: by an
    /// absolute name, by "..", or by links. Where the system lacks openat2() (Linux 5.6) no link is followed:
    /// ELOOP or ENOTDIR.
    Descriptor open(const fs::path& relative, int flags) const;
    /// The same in steps, as without openat2().
    Descriptor open_in_steps(const fs::path& relative, int flags) const;

    /// Folders, then files, each by name. Throws FileError.
    std::vector<FolderEntry> list(const fs::path& relative) const;

  private:
    fs::path path_;
    Descriptor folder_;
};

/// What this thread reads while the object lives, and the loops that it runs on all cores, is opened beneath
/// a folder: InputFile refuses everything else. Scopes nest; the innermost counts. Null: anything can be
/// read.
class FolderScope {
  public:
    /// The folder must outlive the scope.
    explicit FolderScope(const Folder* folder);
    ~FolderScope();
    FolderScope(const FolderScope&) = delete;
    FolderScope& operator=(const FolderScope&) = delete;

    /// Of this thread; null: none.
    static const Folder* current();

  private:
    const Folder* outer_;
};

}  // namespace easypbr
