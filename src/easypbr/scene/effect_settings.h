// What each effect brings to the settings: its rows of the table, and what is inferred for its automatic
// values. Both are defined in the effect's folder.
#pragma once

#include <string_view>
#include <vector>

#include "easypbr/scene/auto_parameters.h"
#include "easypbr/scene/fields.h"

namespace easypbr::detail {

/// What an effect's values are inferred from. The camera, the lights and the environment are resolved
/// already, and the effects before it in the list.
struct EffectContext {
    const Content& content;
    Vec2i size;                ///< of the picture
    int samples;               ///< of the picture
    const Settings& given;     ///< by the user
    const Settings& settings;  ///< as far as they are inferred
    ResolvedSettings& resolved;
};

/// Whether the user gives a setting of a group ("ssao.") another value than its default.
bool is_asked_for(const Settings& given, std::string_view group);

#define EASYPBR_DECLARE(name, Type)             \
    void add_##name(std::vector<Field>& table); \
    void infer(decltype(Settings::name)& effect, const EffectContext& context);
EASYPBR_EFFECTS(EASYPBR_DECLARE)
#undef EASYPBR_DECLARE

}  // namespace easypbr::detail
