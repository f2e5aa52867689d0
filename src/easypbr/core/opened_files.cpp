#include "easypbr/core/opened_files.h"

#include <utility>

namespace easypbr {
namespace {

thread_local OpenedFiles* innermost_files = nullptr;

}  // namespace

OpenedFiles::OpenedFiles() : outer_(OpenedFilesScope::current()) {}

void OpenedFiles::add(const fs::path& path, fs::file_time_type time) {
    if (outer_) outer_->add(path, time);
    const std::lock_guard lock(mutex_);
    times_.try_emplace(path, time);
}

OpenedFilesScope::OpenedFilesScope(OpenedFiles* files) : outer_(std::exchange(innermost_files, files)) {}

OpenedFilesScope::~OpenedFilesScope() {
    innermost_files = outer_;
}

OpenedFiles* OpenedFilesScope::current() {
    return innermost_files;
}

}  // namespace easypbr
