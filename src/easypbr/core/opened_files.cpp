#include "easypbr/core/opened_files.h"

#include <utility>

namespace easypbr {
namespace {

thread_local OpenedFiles* innermost_files = nullptr;

}  // namespace

OpenedFiles::OpenedFiles() : outer_(OpenedFilesScope::current()) {}

void OpenedFiles::add(const fs::path& path) {
    if (outer_) outer_->add(path);
    const std::lock_guard lock(mutex_);
    paths_.insert(path);
}

OpenedFilesScope::OpenedFilesScope(OpenedFiles* files) : outer_(std::exchange(innermost_files, files)) {}

OpenedFilesScope::~OpenedFilesScope() {
    innermost_files = outer_;
}

OpenedFiles* OpenedFilesScope::current() {
    return innermost_files;
}

}  // namespace easypbr
