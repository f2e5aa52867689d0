#include "easypbr/remote/encoder.h"

#include <utility>

#include "easypbr/core/log.h"
#include "easypbr/core/start_thread.h"
#include "easypbr/core/stopwatch.h"
#include "easypbr/io/image/image_codecs.h"
#include "easypbr/io/image/image_io.h"

namespace easypbr::remote {
namespace {

std::vector<std::byte> bytes_of(const EncodeJob& job) {
    if (job.header.codec == Codec::png) return io::encode_png(job.image);
    if (job.header.kind == FrameKind::moving) return io::encode_jpeg_quickly(job.image, job.quality);
    return io::encode_jpeg(job.image, job.quality);
}

}  // namespace

Picture encode(EncodeJob job) {
    double seconds = 0;
    Picture picture{job.header, {}};
    {
        const Stopwatch watch(seconds);
        picture.bytes = std::make_shared<const std::vector<std::byte>>(bytes_of(job));
    }
    describe(picture.header, job.image, *picture.bytes, seconds);
    return picture;
}

void describe(FrameHeader& header, const Image& image, const std::vector<std::byte>& bytes, double seconds) {
    header.width = uint16_t(image.width());
    header.height = uint16_t(image.height());
    header.bytes = uint32_t(bytes.size());
    header.encode_us = uint32_t(seconds * 1e6);
}

Encoder::Encoder(Work work)
    : work_(std::move(work)), thread_(started([this] { return std::thread([this] { run(); }); })) {}

Encoder::~Encoder() {
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void Encoder::add(EncodeJob job) {
    {
        const std::lock_guard lock(mutex_);
        next_ = std::move(job);
    }
    changed_.notify_all();
}

size_t Encoder::pending() const {
    const std::lock_guard lock(mutex_);
    return size_t(working_) + size_t(next_.has_value());
}

void Encoder::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [&] { return closed_ || next_; });
        if (closed_) return;
        EncodeJob job = std::move(*next_);
        next_.reset();
        working_ = true;
        lock.unlock();
        try {
            work_(std::move(job));
        } catch (const std::exception& error) {
            log_warning(std::string("a picture was not sent: ") + error.what());
        }
        lock.lock();
        working_ = false;
    }
}

}  // namespace easypbr::remote
