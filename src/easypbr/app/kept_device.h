// The device that a session draws by, replaced when its OpenGL context is lost.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "easypbr/app/drawn.h"
#include "easypbr/core/error.h"
#include "easypbr/core/picture.h"
#include "easypbr/gl/context.h"

namespace easypbr::app {

/// After one loss another context takes the place of the lost one, with a warning; after a second one the CPU
/// draws, unless OpenGL was asked for; after a third, or else after the second, gl::ContextLost is thrown.
/// A drawing that succeeds makes up for the losses before it. Copies are handles of one device, for one
/// thread at a time.
class KeptDevice {
  public:
    Device* operator->() const { return state_->device.get(); }
    const std::shared_ptr<Device>& shared() const { return state_->device; }
    /// Another number for another device.
    uint64_t number() const { return state_->number; }

    /// Makes the context when there is none yet. Throws ContextError.
    const gl::ContextInfo& info();
    /// Throws ArgumentError when another one is there already.
    void ask_for(DrawDevice device);

    /// The context is lost and current, so that it cannot be replaced yet.
    bool is_stuck() const;
    /// Replaces a lost context, unless it is current: objects made in it are void then.
    void replace_lost();

    /// What a job returns that draws; it is done again where the context was lost. Where that is current
    /// already, gl::ContextLost is left to who made it so. Throws ArgumentError within a job of this thread,
    /// which a pass or another function of the program's own may have asked for: the outer job's picture is
    /// half drawn.
    template <class Job>
    auto keep(Job&& job) {
        if (state_->thread == std::this_thread::get_id()) refuse_nested();
        if (state_->thread != std::thread::id()) return job();  // It waits for the context.
        const bool is_nested = is_current();
        state_->thread = std::this_thread::get_id();
        const std::unique_ptr<State, void (*)(State*)> end(
            state_.get(), [](State* state) { state->thread = std::thread::id(); });
        for (;;) try {
                replace_lost();
                auto result = job();
                state_->losses = 0;
                return result;
            } catch (const Error& error) {
                const std::string reason = loss(error);
                if (reason.empty()) throw;
                if (is_nested) throw gl::ContextLost(reason);
                replace(reason);
            }
    }

  private:
    [[noreturn]] static void refuse_nested();
    bool is_current() const;
    /// Why the context is lost when a drawing failed, which the driver is asked about: what it answers in a
    /// lost context may look like another error. Empty: it is not lost.
    std::string loss(const Error& error) const;
    void replace(const std::string& reason);

    struct State {
        std::shared_ptr<Device> device = std::make_shared<Device>();
        uint64_t number = 1;
        std::atomic<std::thread::id> thread{};  ///< that runs a job
        int losses = 0;                         ///< since a drawing succeeded
        DrawDevice asked = DrawDevice::automatic;
    };
    std::shared_ptr<State> state_ = std::make_shared<State>();
};

}  // namespace easypbr::app
