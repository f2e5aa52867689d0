// --style and --label-map: how objects are drawn, all of them or one by its name.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace easypbr {
class LabelMap;
class Mesh;
}  // namespace easypbr

namespace easypbr::cli {

/// "key=value" for all objects, "NAME.key=value" for one.
struct StyleOption {
    std::string object;  ///< empty: all
    std::string key, value;
};

/// Throws UsageError for a text of another form, an unknown key or a value that cannot be understood, and for
/// an object that is none of `names`.
std::vector<StyleOption> parse_styles(const std::vector<std::string>& texts,
                                      const std::vector<std::string>& names);

/// Gives the object of that name, descendants included, what the options say about it, and whatever of it has
/// labels the label map, unless that is null. Throws ArgumentError when labels are not in the map.
void style_object(const std::string& name, const std::vector<StyleOption>& styles,
                  const std::shared_ptr<const LabelMap>& label_map, const Mesh& mesh);

}  // namespace easypbr::cli
