// How long passes take, when somebody wants to know.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/gl/draw.h"

namespace easypbr::render {

class PassTimer {
  public:
    /// From now on every pass is finished before the next begins, and timed.
    void enable(bool enabled) { enabled_ = enabled; }
    void reset() {
        times_.clear();
        running_ = false;
    }
    /// Milliseconds of each pass since reset(), in the order of their first runs, summed.
    const std::vector<std::pair<std::string, double>>& times() const { return times_; }

    /// Runs a pass and returns what it returns. What it runs within itself counts as its own. Where the
    /// driver is missing, errors name the pass that needs it.
    template <class Pass>
    auto run(const std::string& name, Pass&& pass) {
        const Run run(*this, name);
        try {
            return pass();
        } catch (const ContextError& error) {
            if (gl::has_driver()) throw;
            throw ContextError(name + ": " + error.what());
        }
    }

  private:
    using Clock = std::chrono::steady_clock;

    class Run {
      public:
        Run(PassTimer& timer, const std::string& name)
            : timer_(timer), name_(name), measures_(timer.enabled_ && !timer.running_) {
            if (!measures_) return;
            gl::finish();
            timer_.running_ = true;
            start_ = Clock::now();
        }
        ~Run() {
            if (!measures_) return;
            timer_.running_ = false;
            gl::finish();
            timer_.add(name_, std::chrono::duration<double, std::milli>(Clock::now() - start_).count());
        }
        Run(const Run&) = delete;
        Run& operator=(const Run&) = delete;

      private:
        PassTimer& timer_;
        const std::string& name_;
        bool measures_;
        Clock::time_point start_;
    };

    void add(const std::string& name, double ms) {
        for (auto& [known, sum] : times_)
            if (known == name) {
                sum += ms;
                return;
            }
        times_.emplace_back(name, ms);
    }

    bool enabled_ = false, running_ = false;
    std::vector<std::pair<std::string, double>> times_;
};

}  // namespace easypbr::render
