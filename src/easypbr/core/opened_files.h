// Which files were opened while something was read.
#pragma once

#include <mutex>
#include <set>

#include "easypbr/core/file.h"

namespace easypbr {

/// Paths as they were given to InputFile, those of files that could not be opened among them.
class OpenedFiles {
  public:
    /// What is noted here is noted in those of the scope around it as well.
    OpenedFiles();
    OpenedFiles(const OpenedFiles&) = delete;
    OpenedFiles& operator=(const OpenedFiles&) = delete;

    /// Thread-safe.
    void add(const fs::path& path);
    /// When all has been read.
    const std::set<fs::path>& paths() const { return paths_; }

  private:
    OpenedFiles* outer_;
    std::mutex mutex_;
    std::set<fs::path> paths_;
};

/// What InputFile opens in this thread while the object lives, and in the loops that it runs on all cores, is
/// noted. Scopes nest; the innermost counts. Null: nothing is noted.
class OpenedFilesScope {
  public:
    /// `files` must outlive the scope.
    explicit OpenedFilesScope(OpenedFiles* files);
    ~OpenedFilesScope();
    OpenedFilesScope(const OpenedFilesScope&) = delete;
    OpenedFilesScope& operator=(const OpenedFilesScope&) = delete;

    /// Of this thread; null: none.
    static OpenedFiles* current();

  private:
    OpenedFiles* outer_;
};

}  // namespace easypbr
