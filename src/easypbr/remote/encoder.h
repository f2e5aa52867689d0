// Encoder: pictures to bytes, beside the drawing.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "easypbr/core/image.h"
#include "easypbr/remote/clients.h"

namespace easypbr::remote {

/// What is to be made of a picture.
struct EncodeJob {
    Image image;         ///< RGBA u8
    FrameHeader header;  ///< kind, codec and flags say how; size and encode_us are filled in
    int quality = 80;    ///< of a JPEG
    double rate = 0;     ///< bits per second of a video
};

/// Throws ArgumentError for what the format does not hold.
Picture encode(EncodeJob job);
/// Writes into a header what was made of a picture, in so many seconds.
void describe(FrameHeader& header, const Image& image, const std::vector<std::byte>& bytes, double seconds);

/// A thread for the newest job: one that has not begun when another comes is dropped.
class Encoder {
  public:
    using Work = std::function<void(EncodeJob)>;
    /// `work` is called on the encoder's thread.
    explicit Encoder(Work work);
    ~Encoder();
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;

    void add(EncodeJob job);
    /// Something is being encoded or waits for it.
    bool is_busy() const { return pending() > 0; }
    /// Jobs that will come out of it.
    size_t pending() const;

  private:
    void run();

    Work work_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<EncodeJob> next_;
    bool closed_ = false, working_ = false;
    std::thread thread_;
};

}  // namespace easypbr::remote
