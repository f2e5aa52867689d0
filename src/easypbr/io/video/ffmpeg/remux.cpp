#include "easypbr/io/video/ffmpeg/remux.h"

#include "easypbr/io/video/ffmpeg/handles.h"
#include "easypbr/io/video/video_file.h"

namespace easypbr::io {
namespace {

namespace fs = std::filesystem;

Input open_input(const fs::path& path) {
    AVFormatContext* raw = nullptr;
    require_written(avformat_open_input(&raw, path.c_str(), nullptr, nullptr), path);
    Input input(raw);
    require_written(avformat_find_stream_info(input.get(), nullptr), path);
    return input;
}

void copy_packets(AVFormatContext& input, const fs::path& path, const fs::path& to) {
    AVFormatContext* raw = nullptr;
    require_written(
        avformat_alloc_output_context2(&raw, nullptr, path.extension() == ".mov" ? "mov" : "mp4", to.c_str()),
        path);
    const Output output(raw);
    const AVStream& from = *input.streams[0];
    AVStream& stream = *avformat_new_stream(output.get(), nullptr);
    require_written(avcodec_parameters_copy(stream.codecpar, from.codecpar), path);
    stream.codecpar->codec_tag = 0;
    stream.time_base = from.time_base;
    stream.avg_frame_rate = from.avg_frame_rate;
    require_written(avio_open(&output->pb, to.c_str(), AVIO_FLAG_WRITE), path);
    AVDictionary* options = nullptr;
    av_dict_set(&options, "movflags", "+faststart", 0);
    const int begun = avformat_write_header(output.get(), &options);
    av_dict_free(&options);
    require_written(begun, path);
    const Packet packet(av_packet_alloc());
    int read = 0;
    while ((read = av_read_frame(&input, packet.get())) >= 0) {
        av_packet_rescale_ts(packet.get(), from.time_base, stream.time_base);
        packet->pos = -1;
        require_written(av_interleaved_write_frame(output.get(), packet.get()), path);
    }
    if (read != AVERROR_EOF) require_written(read, path);
    require_written(av_write_trailer(output.get()), path);
    require_written(output->pb->error, path);
    require_written(avio_closep(&output->pb), path);
}

}  // namespace

void index_first(const fs::path& path) {
    VideoFile ordinary = VideoFile::create_temporary(path);
    copy_packets(*open_input(path), path, ordinary.path());
    ordinary.replace(path);
}

}  // namespace easypbr::io
