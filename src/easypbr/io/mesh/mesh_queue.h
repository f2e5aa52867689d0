// Reading many files ahead of where they are used.
#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "easypbr/scene/mesh.h"

namespace easypbr::io {

/// Meshes of a list of files in its order, read by threads of its own (the paper's parallel loader). At most
/// `prefetch` meshes are held or being read beyond the one that next() gave last, whatever their number.
class MeshQueue {
  public:
    /// Throws ArgumentError unless workers and prefetch are at least 1, Error where the system gives no
    /// thread; where it gives some, these read.
    MeshQueue(std::vector<std::filesystem::path> paths, int workers, int prefetch);
    /// Gives up the files that are being read.
    ~MeshQueue();
    MeshQueue(const MeshQueue&) = delete;
    MeshQueue& operator=(const MeshQueue&) = delete;

    /// The next file's mesh, waiting for it; nothing after the last one. What reading it threw is thrown
    /// here, at its place; the next call goes on with the file after it. Throws Interrupted, after which the
    /// next call goes on with the same file.
    std::optional<Mesh> next();

    size_t size() const { return paths_.size(); }

  private:
    struct Result {
        std::optional<Mesh> mesh;
        std::exception_ptr error;
    };
    void work();

    const std::vector<std::filesystem::path> paths_;
    const size_t prefetch_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::map<size_t, Result> results_;
    size_t claimed_ = 0, given_ = 0;
    std::atomic<bool> stop_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace easypbr::io
