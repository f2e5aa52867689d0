// A viewer that threads take turns in, as Python holds it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <type_traits>

#include "easypbr/app/session.h"
#include "easypbr/core/error.h"
#include "easypbr/core/interrupt.h"
#include "easypbr/core/own_process.h"
#include "easypbr/python/bindings.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/image_inbox.h"
#include "easypbr/viewer/viewer.h"

namespace easypbr::python {

/// Lets threads in by the order in which they came: a loop that updates a window leaves others their turn. A
/// thread whose turn it is comes in again at once: its callbacks use the viewer that calls them.
class Turns {
  public:
    /// Throws ContextError when it would wait for ever: the thread inside waits, within a callback, for a
    /// viewer that this thread is in. Throws Interrupted.
    void lock() {
        const std::thread::id self = std::this_thread::get_id();
        std::unique_lock lock(mutex());
        if (owner_ == self) {
            ++depth_;
            return;
        }
        if (waits_for(self))
            throw ContextError(
                "two viewers wait for each other: callbacks of both use the other one, on two threads; "
                "update them on one thread");
        const uint64_t turn = next_++;
        waiting()[self] = this;
        try {
            while (!changed_.wait_for(lock, std::chrono::milliseconds(20), [&] { return turn == served_; }))
                check_interrupt();
        } catch (const Interrupted&) {
            waiting().erase(self);
            given_up_.insert(turn);
            throw;
        }
        waiting().erase(self);
        owner_ = self;
        depth_ = 1;
    }
    /// Comes in if nobody is inside or waits.
    bool try_lock() {
        const std::lock_guard lock(mutex());
        const std::thread::id self = std::this_thread::get_id();
        if (owner_ == self) {
            ++depth_;
            return true;
        }
        if (next_ != served_) return false;
        ++next_;
        owner_ = self;
        depth_ = 1;
        return true;
    }
    void unlock() {
        {
            const std::lock_guard lock(mutex());
            if (--depth_ > 0) return;
            owner_ = {};
            ++served_;
            while (given_up_.erase(served_) > 0) ++served_;
        }
        changed_.notify_all();
    }

  private:
    /// One for all viewers, held for moments, so that it can be seen who waits for whom.
    static std::mutex& mutex() {
        static std::mutex mutex;
        return mutex;
    }
    static std::map<std::thread::id, const Turns*>& waiting() {
        static std::map<std::thread::id, const Turns*> waiting;
        return waiting;
    }
    /// Whether who is in here waits for a thread, perhaps by way of others.
    bool waits_for(std::thread::id thread) const {
        std::set<const Turns*> seen;
        for (const Turns* turns = this; turns && seen.insert(turns).second;) {
            if (turns->owner_ == thread) return true;
            const auto next = waiting().find(turns->owner_);
            turns = next == waiting().end() ? nullptr : next->second;
        }
        return false;
    }

    std::condition_variable changed_;
    uint64_t next_ = 0, served_ = 0;
    std::set<uint64_t> given_up_;  ///< turns that nobody waits for any more
    std::thread::id owner_;
    int depth_ = 0;
};

/// A viewer that threads take turns in.
class SharedViewer {
  public:
    SharedViewer(const Scene& scene, DrawDevice device) : shared_(new Shared(scene, device)) {}

    template <class Work>
    auto run(Work&& work) {
        return released([&] {
            require_same_process();
            const std::lock_guard lock(shared_->turns);
            Viewer& viewer = shared_->viewer;
            shared_->images.deliver(viewer);
            if constexpr (std::is_void_v<decltype(work(viewer))>) {
                work(viewer);
                viewer.tell_servers();
            } else {
                auto result = work(viewer);
                viewer.tell_servers();
                return result;
            }
        });
    }

    /// Shows an image beside the scene: at once, or, where another thread is inside, before the next turn.
    /// Does not wait for one. Throws as Viewer::show_image().
    void show_image(const std::string& name, Image image, const gui::ImageLook& look) {
        released([&] {
            require_same_process();
            shared_->images.put(name, std::move(image), look);
            const std::unique_lock lock(shared_->turns, std::try_to_lock);
            if (lock) shared_->images.deliver(shared_->viewer);
        });
    }

    /// Keeps an exception that a callback must not swallow (KeyboardInterrupt) until update() is over.
    void keep_exception(std::exception_ptr exception) { kept_ = std::move(exception); }
    std::exception_ptr take_exception() { return std::exchange(kept_, nullptr); }

  private:
    void require_same_process() const {
        if (!shared_.get_deleter().process.is_this())
            throw ContextError(
                "this viewer belongs to the process that this one was forked from: GL contexts do not "
                "survive a fork; start processes with multiprocessing.get_context('spawn')");
    }

    struct Shared {
        Shared(const Scene& scene, DrawDevice device) : viewer(scene, device) {}

        Turns turns;
        ImageInbox images;
        Viewer viewer;
    };

    std::exception_ptr kept_;
    std::unique_ptr<Shared, DeleteInOwnProcess> shared_;
};

inline std::optional<Vec2i> optional_size(const nb::object& size) {
    if (size.is_none()) return std::nullopt;
    return to_size(size, "size");
}

void bind_recorder(nb::module_& module, nb::class_<SharedViewer>& viewer);
void bind_gui(nb::module_& module, nb::class_<SharedViewer>& viewer);
void bind_server(nb::module_& module, nb::class_<SharedViewer>& viewer);

/// Viewer::update(); then raise_kept().
bool update_window(SharedViewer& self);
/// Throws what a callback of the last update or screenshot threw to end the program.
void raise_kept(SharedViewer& self);

}  // namespace easypbr::python
