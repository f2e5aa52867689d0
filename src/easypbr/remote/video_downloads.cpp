#include "easypbr/remote/video_downloads.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <map>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"

namespace easypbr::remote {
namespace {

namespace fs = std::filesystem;

const std::map<std::string, Codec>& codecs() {
    static const std::map<std::string, Codec> codecs = {
        {"gif", Codec::gif}, {"mp4", Codec::mp4}, {"webm", Codec::webm}};
    return codecs;
}

/// That nobody else can look into.
fs::path new_folder() {
    std::string name = (fs::temp_directory_path() / "easypbr-video-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw FileError(name + ": cannot make this folder");
    return name;
}

}  // namespace

void VideoDownloads::clear() {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
    folder_.clear();
    made_.reset();
}

const std::vector<std::string>& VideoDownloads::formats() {
    static const std::vector<std::string> formats = {"mp4", "webm", "gif"};
    return formats;
}

fs::path VideoDownloads::file() const {
    return folder_ / ("recording." + made_.value_or(form.format));
}

void VideoDownloads::begin(app::LiveWishes::Recording what) {
    if (folder_.empty()) folder_ = new_folder();
    made_.reset();
    // A recording takes the place of the last one.
    std::error_code absent;
    fs::remove(file(), absent);
    app::RecordingForm& recorded = live_.recording_form();
    recorded.video = file().string();
    // H.264 has even sides.
    recorded.size = form.size / 2 * 2;
    recorded.fps = form.fps;
    live_.wishes().recording = what;
}

bool VideoDownloads::advance() {
    const app::LiveRecording& recording = live_.recording();
    const bool ran = std::exchange(runs_, recording.is_running());
    std::error_code absent;
    const uint64_t bytes = runs_ ? fs::file_size(file(), absent) : 0;
    if (recording.frames() >= most_frames || (!absent && bytes > most_bytes)) stop();
    if (!ran || runs_ || live_.report().failed) return false;
    made_ = form.format;
    return true;
}

Picture VideoDownloads::fetch(uint32_t frame) const {
    if (!made_) throw ArgumentError("nothing has been recorded");
    Picture picture;
    picture.header.kind = FrameKind::file;
    picture.header.codec = codecs().at(*made_);
    picture.header.frame = frame;
    const FileBytes read(file());
    picture.bytes = std::make_shared<const std::vector<std::byte>>(read.bytes().begin(), read.bytes().end());
    read.check();
    return picture;
}

std::string VideoDownloads::plain(std::string text) const {
    const std::string prefix = folder_.string() + "/";
    for (size_t at = 0; !folder_.empty() && (at = text.find(prefix, at)) != text.npos;)
        text.erase(at, prefix.size());
    return text;
}

}  // namespace easypbr::remote
