#include "easypbr/io/tables/misfits.h"

#include <fmt/format.h>

#include "easypbr/core/log.h"

namespace easypbr::io {

void Misfits::warn(const Source& source) const {
    for (const auto& [name, count] : counts_)
        log_warning(fmt::format("{}: {} values of '{}' are no integers of 32 bits and become -1",
                                source.path.string(), count, name));
}

}  // namespace easypbr::io
