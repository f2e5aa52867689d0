// Python functions that C++ keeps.
#pragma once

#include <memory>
#include <utility>

#include "easypbr/python/bindings.h"

namespace easypbr::python {

/// A Python function that C++ may drop on any thread.
inline std::shared_ptr<nb::object> held(nb::object function) {
    return {new nb::object(std::move(function)), [](nb::object* object) {
                const nb::gil_scoped_acquire gil;
                delete object;
            }};
}

}  // namespace easypbr::python
