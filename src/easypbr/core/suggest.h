// "Did you mean": the nearest of the valid names to a misspelt one.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace easypbr {

/// The nearest candidate within a third of its letters; empty when none is near.
std::string nearest(std::string_view wrong, std::span<const std::string> candidates);

/// " (did you mean 'NAME'?)" for nearest(); empty when none is near.
std::string did_you_mean(std::string_view wrong, std::span<const std::string> candidates);

}  // namespace easypbr
