// Files that belong together, written as one.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/core/file.h"

namespace easypbr {

/// A new name for a file while it is written, short whatever it will be called:
/// ".easypbr.PROCESS.NUMBER.tmp".
std::string temporary_name();
bool is_temporary_name(std::string_view name);

/// Writes all bytes to an open file; `path` stands in messages. Throws FileError.
void write_all(int descriptor, std::span<const std::byte> bytes, const std::filesystem::path& path);

/// All files of a set appear at once, or none: each is written beside its target, and commit() renames them.
/// A set that is destroyed before leaves nothing behind, and the files that were there as they were. A file
/// that cannot be replaced but written (it is mounted, or its folder takes no other) is written into by
/// commit(), and is incomplete where that fails. Move-only.
class FileSet {
  public:
    FileSet() = default;
    ~FileSet();
    FileSet(FileSet&&) = default;
    FileSet& operator=(FileSet&&) = delete;

    /// Writes a file beside `path`; a link is followed. Throws FileError.
    void add(const std::filesystem::path& path, std::span<const std::byte> bytes);
    void add(const std::filesystem::path& path, std::string_view text);
    /// Renames all, or writes into them, in the order in which they were added. Throws FileError; when a
    /// target cannot be written, none is changed.
    void commit();

  private:
    struct File {
        std::filesystem::path beside, target;  ///< `beside` is empty where the bytes wait in memory
        Descriptor in_memory;
    };
    std::vector<File> files_;
};

/// Where a file of this name really lies: a link is followed, also one that leads to no file yet.
std::filesystem::path real_target(std::filesystem::path path);

/// Puts a file that was written whole in the place of another, whose owner and permissions it takes. Throws
/// FileError.
void replace_file(const std::filesystem::path& target, const std::filesystem::path& by);

}  // namespace easypbr
