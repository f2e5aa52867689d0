// Rows of the panels: a name, a value that suits the field, a tick where it can be automatic.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "easypbr/gui/item_places.h"
#include "easypbr/scene/fields.h"

namespace easypbr::gui {

/// Begins a table of rows, with a column for the word "auto" or without; end_rows() only when it returned
/// true.
bool begin_rows(const char* id, bool with_auto = true);
void end_rows();

/// The first cells of a custom row; the value's widget comes next and fills the second column.
void begin_row(const std::string& name, const std::string& tooltip = {});

/// A field's name as it is read: "exposure compensation".
std::string readable(const std::string& name);
/// What the field means, its unit, range and full name.
std::string tooltip_of(const FieldInfo& field);

/// A row for a field whose value is `value`; `inferred` is shown while it is automatic. Calls `put` with what
/// the person chose. The value's place is noted under the field's name.
void field_row(const FieldInfo& field, const Value& value, const std::optional<Value>& inferred,
               const std::function<void(const Value&)>& put);

/// A heading that folds its panel or group.
bool heading(const char* text, bool open = true);

/// A button that notes its place as "panel/name".
bool named_button(const char* panel, const char* name, float width, bool enabled = true);

/// Text that is less important.
void dim_text(const std::string& text);

}  // namespace easypbr::gui
