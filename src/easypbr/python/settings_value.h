// Settings' values between Python and the table of fields.
#pragma once

#include <optional>

#include "easypbr/python/bindings.h"
#include "easypbr/scene/auto.h"
#include "easypbr/scene/fields.h"

namespace easypbr::python {

/// Python's `auto`, and what an automatic setting reads as: it then carries the value inferred so far.
struct Automatic {
    std::optional<Value::Data> value;
};
/// Python's `follow`.
struct Follow {};

/// Throws ArgumentError when the object is no setting's value at all; the field's own check comes later.
Value value_from_python(const FieldInfo& field, nb::handle object);
nb::object value_to_python(const FieldInfo& field, const Value& value);

}  // namespace easypbr::python
