// The device that a session draws by, replaced when its OpenGL context is lost.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

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
    /// already, gl::ContextLost is left to who made it so.
    template <class Job>
    auto keep(Job&& job) {
        if (state_->keeps) return job();
        const bool is_nested = is_current();
        state_->keeps = true;
        const std::unique_ptr<bool, void (*)(bool*)> end(&state_->keeps, [](bool* keeps) { *keeps = false; });
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
    bool is_current() const;
    /// Why the context is lost when a drawing failed, which the driver is asked about: what it answers in a
    /// lost context may look like another error. Empty: it is not lost.
    std::string loss(const Error& error) const;
    void replace(const std::string& reason);

    struct State {
        std::shared_ptr<Device> device = std::make_shared<Device>();
        uint64_t number = 1;
        bool keeps = false;
        int losses = 0;  ///< since a drawing succeeded
        DrawDevice asked = DrawDevice::automatic;
    };
    std::shared_ptr<State> state_ = std::make_shared<State>();
};

}  // namespace easypbr::app
