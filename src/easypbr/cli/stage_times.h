// Times of the stages of a job.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace easypbr::cli {

class Stopwatch {
  public:
    /// Keeps the time since construction, the last lap or restart under a name.
    void lap(const std::string& stage) {
        add(stage, seconds_since(lap_));
        restart();
    }
    /// Adds a time that was measured elsewhere.
    void add(const std::string& stage, double seconds) {
        for (auto& [name, sum] : stages_)
            if (name == stage) return void(sum += seconds);
        stages_.emplace_back(stage, seconds);
    }
    void restart() { lap_ = Clock::now(); }

    const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }
    double total() const { return seconds_since(start_); }

    /// "load 0.120 s, ..., total 0.520 s"
    std::string summary() const {
        std::string text;
        for (const auto& [stage, seconds] : stages_) text += fmt::format("{} {:.3f} s, ", stage, seconds);
        return text + fmt::format("total {:.3f} s", total());
    }

  private:
    using Clock = std::chrono::steady_clock;
    static double seconds_since(Clock::time_point start) {
        return std::chrono::duration<double>(Clock::now() - start).count();
    }
    Clock::time_point start_ = Clock::now(), lap_ = start_;
    std::vector<std::pair<std::string, double>> stages_;
};

}  // namespace easypbr::cli
