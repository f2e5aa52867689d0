// What the server tells in words: JSON texts. Names come from files, so texts are escaped and made valid
// UTF-8.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "easypbr/app/live_picture.h"
#include "easypbr/app/notifications.h"
#include "easypbr/scene/fields.h"

namespace easypbr {
class Scene;
}

namespace easypbr::remote {

/// A setting's value: as it was given ("auto" and "follow" too), and what is in force where that is known.
struct FieldText {
    std::string given, latched;
    bool operator==(const FieldText&) const = default;
};
using FieldTexts = std::map<std::string, FieldText>;

/// Whether clients may set it: nothing that names a file or a program's text, and nothing that is the
/// server's. New fields of type text are not.
bool is_open(const FieldInfo& field);
/// What a client may set of a value that is allowed otherwise. Throws ArgumentError for more samples than a
/// server draws.
void check_client_value(const FieldInfo& field, const Value& value);
inline constexpr double most_client_samples = 4096;

/// What a field is: type, range, unit, documentation. JSON has no infinity: a range without an end has no
/// member.
nlohmann::json description_of(const FieldInfo& field);
FieldText text_of(const FieldInfo& field, const Value& value);
FieldTexts texts_of(const Settings& settings);
/// What `now` has that `before` has not.
FieldTexts changed(const FieldTexts& before, const FieldTexts& now);

/// The table of settings, channels, and whether the client may only watch.
std::string welcome_text(const std::string& session, bool watches_only);
std::string settings_text(const FieldTexts& changed);
std::string camera_message(const std::string& camera);
std::string scene_text(const Scene& scene, const std::string& selected, const std::string& channel);
struct ControlReport {
    bool controls = false, taken = false, may_control = false;
    size_t clients = 0;
    uint16_t view = 0;          ///< that the client looks at, as headers name it; 0: the shared one
    bool may_have_own = false;  ///< a view of its own, unless there are too many
};
std::string control_text(const ControlReport& report);
std::string notice_text(const std::string& text, bool is_error);
std::string pick_text(uint32_t id, const std::optional<app::Pick>& pick, const Scene& scene);
std::string animation_text(const std::vector<std::string>& names, size_t current, bool plays, double time_s,
                           double duration_s, double speed);

struct StatisticsReport {
    app::LiveStatistics drawing;
    double share = 1;      ///< of the best moving picture's bytes
    double latency_s = 0;  ///< of the controlling client
    bool software = false;
};
std::string statistics_text(const StatisticsReport& report);

}  // namespace easypbr::remote
