#include "easypbr/app/picture_ring.h"

#include <numeric>
#include <utility>

namespace easypbr::app {

void PictureRing::make_room() {
    while (slots_.size() >= most_pending) take_oldest();
}

void PictureRing::draw(const PictureOptions& options, int times) {
    make_room();
    const Drawn drawn = session_.draw(options);
    if (std::exchange(device_, session_.device_number()) != session_.device_number()) spare_.clear();
    gl::Readback memory;
    if (!spare_.empty()) {
        memory = std::move(spare_.back());
        spare_.pop_back();
    }
    slots_.push_back({drawn.read_later(std::move(memory)), times});
}

void PictureRing::take_read() {
    while (!slots_.empty() && slots_.front().pending.is_read()) take_oldest();
}

void PictureRing::drain() {
    while (!slots_.empty()) take_oldest();
}

void PictureRing::take_oldest() {
    Slot slot = std::move(slots_.front());
    slots_.pop_front();
    Image picture = slot.pending.take();
    gl::Readback memory = slot.pending.take_memory();
    if (device_ == session_.device_number()) spare_.push_back(std::move(memory));
    take_(std::move(picture), slot.times);
}

int PictureRing::count() const {
    return std::accumulate(slots_.begin(), slots_.end(), 0,
                           [](int sum, const Slot& slot) { return sum + slot.times; });
}

}  // namespace easypbr::app
