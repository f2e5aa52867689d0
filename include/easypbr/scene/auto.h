// Auto<T>: a setting that is inferred unless the user gives a value. Override<T>: one that replaces a value
// of an object.
#pragma once

#include <concepts>
#include <optional>
#include <string>
#include <utility>

namespace easypbr {

struct AutomaticTag {};
struct FollowTag {};

/// Assign to an Auto setting to have it inferred (again): once, at the next picture with content, then kept.
inline constexpr AutomaticTag automatic{};

/// Assign to an Auto setting to have it inferred anew for every picture.
inline constexpr FollowTag follow{};

/// A value that is `automatic` (inferred once, then latched), `follow` (inferred at every change) or pinned
/// by the user.
template <class T>
class Auto {
  public:
    Auto() = default;
    Auto(AutomaticTag) {}
    Auto(FollowTag) : mode_(Mode::inferred_always) {}
    Auto(T value) : value_(std::move(value)), mode_(Mode::pinned) {}
    Auto(const char* text) requires std::same_as<T, std::string> : Auto(T(text)) {}
    /// A pointer would be true: also the text "auto".
    template <class Pointed>
    Auto(Pointed*) requires std::same_as<T, bool>
    = delete;

    bool is_pinned() const { return mode_ == Mode::pinned; }
    bool is_follow() const { return mode_ == Mode::inferred_always; }

    /// The pinned or latched value; nothing when it has still to be inferred.
    const std::optional<T>& value() const { return value_; }
    const T& operator*() const { return *value_; }

    T value_or(T inferred) const { return value_ ? *value_ : std::move(inferred); }

    /// Keeps an inferred value. A pinned value stays as it is; one that follows keeps none.
    void latch(T inferred) {
        if (mode_ == Mode::inferred_once) value_ = std::move(inferred);
    }

    /// Forgets a latched value; a pinned one stays.
    void release() {
        if (mode_ != Mode::pinned) value_.reset();
    }

    bool operator==(const Auto&) const = default;

  private:
    enum class Mode { inferred_once, inferred_always, pinned };
    std::optional<T> value_;
    Mode mode_ = Mode::inferred_once;
};

/// Stands for Auto<T> where the value is inferred: the value itself. One definition of a group of settings
/// serves both: users write a BasicBloomSettings<Auto>, an image is drawn with a
/// BasicBloomSettings<Inferred>.
template <class T>
using Inferred = T;

/// A value that replaces the one of an object, or `automatic`: the object keeps its own.
template <class T>
class Override {
  public:
    Override() = default;
    Override(AutomaticTag) {}
    Override(FollowTag) {}
    Override(T value) : value_(std::move(value)) {}
    /// As for Auto.
    template <class Pointed>
    Override(Pointed*) requires std::same_as<T, bool>
    = delete;

    /// Nothing when automatic.
    const std::optional<T>& value() const { return value_; }
    const T& operator*() const { return *value_; }

    T value_or(T own) const { return value_ ? *value_ : std::move(own); }

    bool operator==(const Override&) const = default;

  private:
    std::optional<T> value_;
};

}  // namespace easypbr
