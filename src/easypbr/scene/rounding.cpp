#include "easypbr/scene/rounding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easypbr/core/log.h"
#include "easypbr/core/parallel.h"

namespace easypbr {
namespace {

/// Beyond it double precision itself has no longer every whole number.
constexpr double most_exact_double = 9007199254740992.0;

void warn_of_lost_values(const std::string& where, const std::string& what, const RoundingCounts& counts) {
    if (counts.are_lost())
        log_warning(
            fmt::format("{}{}{} are kept as float32, which {}: subtract an offset from them first, or give "
                        "IDs as labels",
                        where, where.empty() ? "" : ": ", what, counts.text()));
}

}  // namespace

std::string RoundingCounts::Number::text() const {
    if (!is_integer) return fmt::format("{}", high);
    return high < 0 ? fmt::format("{}", int64_t(high) + low)
                    : fmt::format("{}", uint64_t(high) + uint64_t(low));
}

void RoundingCounts::add(const Number& number, float kept) {
    if (!std::isfinite(number.high)) return;
    const double value = number.value();
    low_ = std::min(low_, value);
    high_ = std::max(high_, value);
    if (!number.is_integer && (value != std::floor(value) || std::abs(value) > most_exact_double))
        all_whole_ = false;
    else if (!number.is(double(kept)) && rounded_++ == 0)
        first_rounded_ = number, kept_rounded_ = kept;
    if (std::isfinite(previous_.high) && number != previous_) {
        ++distinct_;
        if (kept == kept_previous_ && merged_++ == 0) first_merged_ = {previous_, number};
    }
    previous_ = number;
    kept_previous_ = kept;
}

void RoundingCounts::add(const RoundingCounts& other) {
    if (rounded_ == 0) first_rounded_ = other.first_rounded_, kept_rounded_ = other.kept_rounded_;
    if (merged_ == 0) first_merged_ = other.first_merged_;
    distinct_ += other.distinct_;
    merged_ += other.merged_;
    rounded_ += other.rounded_;
    all_whole_ = all_whole_ && other.all_whole_;
    low_ = std::min(low_, other.low_);
    high_ = std::max(high_, other.high_);
}

bool RoundingCounts::are_lost_neighbors() const {
    return 2 * merged_ > distinct_ && std::max(std::abs(low_), std::abs(high_)) > 4 * (high_ - low_);
}

std::string RoundingCounts::text() const {
    if (merged_ > 0)
        return fmt::format("holds {} and {} as one number", first_merged_[0].text(), first_merged_[1].text());
    return fmt::format("holds {} as {}", first_rounded_.text(), double(kept_rounded_));
}

RoundingCounts rounding_of(std::span<const double> values) {
    constexpr size_t grain = 1 << 15;
    Rounding rounding;
    parallel_chunks(values.size(), grain, [&](size_t begin, size_t end) {
        RoundingCounts piece;
        for (size_t i = begin; i < end; ++i) piece.add(values[i]);
        rounding.add(piece);
    });
    return rounding.counts();
}

void warn_of_rounding(const std::string& where, const std::string& name, const RoundingCounts& counts) {
    warn_of_lost_values(where, fmt::format("scalars '{}'", name), counts);
}

void warn_of_rounded_intensities(const std::string& where, const RoundingCounts& counts) {
    warn_of_lost_values(where, "intensities", counts);
}

}  // namespace easypbr
