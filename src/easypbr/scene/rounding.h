// What float32 keeps of scalars and intensities given in double precision: time stamps and IDs are too large
// for it.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <limits>
#include <mutex>
#include <span>
#include <string>

namespace easypbr {

/// What becomes of numbers, in their order, when they are stored as float32. Those that are not finite are
/// passed over.
class RoundingCounts {
  public:
    void add(double value) { add(Number{.high = value}, float(value)); }
    /// The same, exact beyond the whole numbers of double precision, too.
    template <std::integral Integer>
    void add(Integer value) {
        if constexpr (sizeof(Integer) < 8)
            add(double(value));
        else {
            // 53 bits, which double precision holds, and 11.
            const Integer low = value & Integer{0x7ff};
            add(Number{double(Integer(value - low)), int(low), true}, float(value));
        }
    }
    /// Joins what was counted of other numbers.
    void add(const RoundingCounts& other);

    /// Whether float32 takes what tells the numbers apart: they are whole numbers, IDs perhaps, that it does
    /// not have, or more than half of the neighbours that differ become equal although they are farther from
    /// zero than 4 times their extent, so that an offset would keep them apart.
    bool are_lost() const { return are_lost_ids() || are_lost_neighbors(); }

    /// "holds 1700000000 and 1700000000.5 as one number"; for are_lost().
    std::string text() const;

  private:
    /// Exactly: the sum of both.
    struct Number {
        double high;
        int low = 0;
        bool is_integer = false;

        double value() const { return high + low; }
        bool is(double other) const { return other - high == low; }
        bool operator==(const Number& other) const { return high == other.high && low == other.low; }
        std::string text() const;
    };

    void add(const Number& number, float kept);
    bool are_lost_ids() const { return all_whole_ && rounded_ > 0; }
    bool are_lost_neighbors() const;

    size_t distinct_ = 0, merged_ = 0;  ///< neighbours that differ, and those of them that become equal
    size_t rounded_ = 0;                ///< whole numbers that float32 has not
    bool all_whole_ = true;
    double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
    Number previous_{.high = std::numeric_limits<double>::quiet_NaN()};
    float kept_previous_ = 0;
    Number first_rounded_{.high = 0};
    float kept_rounded_ = 0;
    std::array<Number, 2> first_merged_{};
};

/// The counts of one scalar field, joined by the threads that read its pieces.
class Rounding {
  public:
    /// `missing`: the value that stands for none.
    explicit Rounding(double missing = std::numeric_limits<double>::quiet_NaN()) : missing_(missing) {}

    /// Counts a value of a piece.
    void count(double value, RoundingCounts& piece) const {
        if (value != missing_) piece.add(value);
    }
    void add(const RoundingCounts& piece) {
        const std::lock_guard lock(mutex_);
        counts_.add(piece);
    }
    void clear() { counts_ = {}; }
    const RoundingCounts& counts() const { return counts_; }

  private:
    const double missing_;
    std::mutex mutex_;
    RoundingCounts counts_;
};

RoundingCounts rounding_of(std::span<const double> values);

/// Logs one warning that names the scalars where float32 takes what tells them apart. `where`: what stands
/// before it, the name of a file or nothing.
void warn_of_rounding(const std::string& where, const std::string& name, const RoundingCounts& counts);
/// The same of intensities.
void warn_of_rounded_intensities(const std::string& where, const RoundingCounts& counts);

}  // namespace easypbr
