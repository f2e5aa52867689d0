// The file that a video is written into.
#pragma once

#include <sys/types.h>

#include <optional>

#include "easypbr/core/file.h"

namespace easypbr::io {

/// A new, empty file for one video, to be opened for writing by its path. Its name was free, so that no other
/// file is written to, not through a link either. It is locked while the video is written. The file is
/// removed with its object unless keep() was called. Move-only.
class VideoFile {
  public:
    /// A file at `path`, where a link may lead to it; nothing where one is there already. Throws FileError.
    static std::optional<VideoFile> create(const fs::path& path);
    /// A file beside a target that is there: by its extension "clip.part.mp4" can be played, or
    /// "clip.part-2.mp4" where that is there already. Who may not read the target may not read it either.
    /// `name`: of the target, as it was given. Throws FileError.
    static VideoFile create_part(const fs::path& target, const fs::path& name);
    /// A file of a temporary name beside a target, for its owner alone. Throws FileError.
    static VideoFile create_temporary(const fs::path& target);

    ~VideoFile();
    VideoFile(VideoFile&&) noexcept = default;
    VideoFile& operator=(VideoFile&&) = delete;

    /// As it was given, for messages.
    const fs::path& name() const { return name_; }
    /// Absolute.
    const fs::path& path() const { return path_; }

    /// To be called when the video is whole: the file stays, and is not locked any more. Throws FileError
    /// when it was removed, or another is in its place.
    void keep();
    /// As keep(), in the place of the target, whose owner and permissions it takes. Throws FileError.
    void replace(const fs::path& target);
    /// Removes the file, but no other that has taken its place.
    void remove();

  private:
    VideoFile(fs::path name, fs::path path, Descriptor file);
    /// Nothing where a file is there already. Throws FileError, which names the path, too, where it is
    /// another.
    static std::optional<VideoFile> create_at(const fs::path& name, const fs::path& path, mode_t mode);
    bool is_in_place() const;
    void require_in_place() const;
    void release();

    fs::path name_, path_;
    Descriptor file_;  ///< until the file is kept or removed
};

/// Whether a video is being written into the file at `path`, by this process or another. False where the file
/// system has no locks.
bool is_being_recorded(const fs::path& path);

}  // namespace easypbr::io
