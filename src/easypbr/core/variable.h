// Environment variables.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

namespace easypbr {

/// Its value; nothing where it is not set, or empty, which is the same for every variable of the library.
inline std::optional<std::string> variable(const char* name) {
    const char* value = std::getenv(name);
    return value && *value ? std::optional<std::string>(value) : std::nullopt;
}

}  // namespace easypbr
