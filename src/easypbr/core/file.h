// Files as bytes: memory-mapped reading and writing that never leaves half a file behind.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace easypbr {

namespace fs = std::filesystem;

/// A file mapped read-only into memory. Move-only.
class MappedFile {
  public:
    MappedFile() = default;
    /// Throws FileError when the file is missing, a folder or not readable.
    explicit MappedFile(const fs::path& path);
    ~MappedFile();
    MappedFile(MappedFile&& other) noexcept;
    MappedFile& operator=(MappedFile&& other) noexcept;

    std::span<const std::byte> bytes() const { return {static_cast<const std::byte*>(data_), size_}; }
    std::string_view text() const { return {static_cast<const char*>(data_), size_}; }
    size_t size() const { return size_; }

    /// Tells the system that bytes [0, end) are not needed again soon, so that they do not count as used
    /// memory.
    void release_until(size_t end) const;

  private:
    void* data_ = nullptr;
    size_t size_ = 0;
};

/// Writes beside the target, then renames: a reader sees the old file or the whole new one. Throws FileError.
void write_file(const fs::path& path, std::span<const std::byte> bytes);
void write_file(const fs::path& path, std::string_view text);

/// Throws FileError unless a file could be written at `path` (its folder exists and is writable, it is no
/// folder). Leaves nothing behind.
void check_writable(const fs::path& path);

/// Extension in lower case without the dot: "ply" for "Drone.PLY", empty when there is none.
std::string extension_of(const fs::path& path);

}  // namespace easypbr
