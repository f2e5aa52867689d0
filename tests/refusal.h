// The message with which something is refused.
#pragma once

#include <string>

#include "easypbr/core/error.h"

namespace easypbr {

/// "taken" where the job throws nothing of this kind.
template <class Refusal = ArgumentError, class Job>
std::string refusal(Job&& job) {
    try {
        job();
    } catch (const Refusal& error) {
        return error.what();
    }
    return "taken";
}

}  // namespace easypbr
