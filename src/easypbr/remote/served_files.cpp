#include "easypbr/remote/served_files.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "easypbr/core/interrupt.h"
#include "easypbr/core/start_thread.h"
#include "easypbr/remote/inbox.h"

namespace easypbr::remote {
namespace {

namespace fs = std::filesystem;

/// How old a list may be, in seconds.
constexpr double list_age_s = 2;

bool is_environment(const std::string& extension) {
    return extension == "hdr" || extension == "exr";
}

bool can_be_opened(const FolderEntry& entry) {
    static const std::vector<std::string> known = io::native_extensions();
    const std::string extension = extension_of(entry.name);
    return entry.is_folder || is_environment(extension) || std::ranges::find(known, extension) != known.end();
}

}  // namespace

struct ServedFiles::Job {
    fs::path path;
    std::atomic<bool> stopped = false;
    std::future<Opened> result;  // Last: its end waits for the thread.

    ~Job() { stopped = true; }
};

ServedFiles::ServedFiles(const fs::path& folder) : folder_(folder) {}
ServedFiles::~ServedFiles() = default;

const std::vector<FolderEntry>& ServedFiles::entries() {
    const double now = now_seconds();
    if (listed_s_ >= 0 && now - listed_s_ < list_age_s) return entries_;
    listed_s_ = now;
    entries_.clear();
    entries_ = folder_.list(place_);
    // A .bin beside glTF is a buffer of it, no scan of KITTI.
    const bool has_gltf = std::ranges::any_of(
        entries_, [](const FolderEntry& entry) { return extension_of(entry.name) == "gltf"; });
    std::erase_if(entries_, [&](const FolderEntry& entry) {
        return !can_be_opened(entry) || (has_gltf && extension_of(entry.name) == "bin");
    });
    return entries_;
}

void ServedFiles::enter(const std::string& name) {
    place_ /= name;
    search.clear();
    listed_s_ = -1;
}

void ServedFiles::leave() {
    place_ = place_.parent_path();
    search.clear();
    listed_s_ = -1;
}

void ServedFiles::open(const std::string& name, const io::LoadOptions& options) {
    stop();
    auto job = std::make_unique<Job>();
    job->path = folder_.path() / place_ / name;
    const auto read = [this, job = job.get(), options]() -> Opened {
        const InterruptScope interrupt([job] { return job->stopped.load(); });
        const FolderScope beneath(&folder_);
        if (is_environment(extension_of(job->path))) return {job->path, Environment(job->path)};
        return {job->path, io::load_scene(job->path, options)};
    };
    job->result = started([&] { return std::async(std::launch::async, read); });
    job_ = std::move(job);
}

std::string ServedFiles::reading() const {
    return job_ ? job_->path.filename().string() : "";
}

void ServedFiles::stop() {
    job_.reset();
}

std::optional<ServedFiles::Opened> ServedFiles::take() {
    if (!job_ || job_->result.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return {};
    const std::unique_ptr<Job> job = std::move(job_);
    return job->result.get();
}

}  // namespace easypbr::remote
