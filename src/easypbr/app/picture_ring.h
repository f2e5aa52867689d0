// PictureRing: pictures drawn one after another, each read back while the next ones are drawn.
#pragma once

#include <deque>
#include <functional>
#include <vector>

#include "easypbr/app/session.h"

namespace easypbr::app {

class PictureRing {
  public:
    /// Called with each picture, in the order in which they were drawn.
    using Take = std::function<void(Image picture, int times)>;

    /// The session must outlive the ring.
    PictureRing(Session& session, Take take) : session_(session), take_(std::move(take)) {}
    /// What was not taken is dropped.
    ~PictureRing() = default;

    /// Draws a picture; `times` is handed on with it. Where `most_pending` are on their way the oldest is
    /// waited for and taken first: make_room() beforehand tells what taking throws from what drawing does.
    void draw(const PictureOptions& options, int times = 1);
    void make_room();
    /// Takes what has been read by now. Throws what taking throws; that picture is lost, others stay.
    void take_read();
    /// Takes all that are on their way. Throws what taking throws.
    void drain();
    /// Pictures on their way, each counted as often as it is meant.
    int count() const;

    static constexpr size_t most_pending = 3;

  private:
    struct Slot {
        PendingPicture pending;
        int times;
    };
    void take_oldest();

    Session& session_;
    Take take_;
    std::deque<Slot> slots_;
    std::vector<gl::Readback> spare_;
    uint64_t device_ = 0;  ///< that they are of
};

}  // namespace easypbr::app
