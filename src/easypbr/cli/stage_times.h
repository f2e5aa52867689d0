// Times of the stages of a job.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "easypbr/core/stopwatch.h"

namespace easypbr::cli {

class StageTimes {
  public:
    /// Keeps the time since construction, the last lap or restart under a name.
    void lap(const std::string& stage) {
        add(stage, lap_.seconds());
        restart();
    }
    /// Adds a time that was measured elsewhere.
    void add(const std::string& stage, double seconds) {
        for (auto& [name, sum] : stages_)
            if (name == stage) return void(sum += seconds);
        stages_.emplace_back(stage, seconds);
    }
    void restart() { lap_.restart(); }

    const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }
    double total() const { return since_start_.seconds(); }

    /// "load 0.120 s, ..., total 0.520 s"
    std::string summary() const {
        std::string text;
        for (const auto& [stage, seconds] : stages_) text += fmt::format("{} {:.3f} s, ", stage, seconds);
        return text + fmt::format("total {:.3f} s", total());
    }

  private:
    Timer since_start_, lap_;
    std::vector<std::pair<std::string, double>> stages_;
};

}  // namespace easypbr::cli
