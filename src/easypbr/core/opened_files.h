// Which files were opened while something was read, and how old they were.
#pragma once

#include <map>
#include <mutex>

#include "easypbr/core/file.h"

namespace easypbr {

/// Files by the paths that were given to InputFile, those that could not be opened among them, but none that
/// the folder of a FolderScope refuses.
class OpenedFiles {
  public:
    /// When each was changed last, as seen when it was first opened: one that is replaced while it is read
    /// has another time afterwards. Of a file that is missing the least time.
    using Times = std::map<fs::path, fs::file_time_type>;

    /// What is noted here is noted in those of the scope around it as well.
    OpenedFiles();
    OpenedFiles(const OpenedFiles&) = delete;
    OpenedFiles& operator=(const OpenedFiles&) = delete;

    /// Before the file is read. Thread-safe.
    void add(const fs::path& path, fs::file_time_type time);
    /// When all has been read.
    const Times& times() const { return times_; }

  private:
    OpenedFiles* outer_;
    std::mutex mutex_;
    Times times_;
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
