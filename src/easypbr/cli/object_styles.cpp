#include "easypbr/cli/object_styles.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "easypbr/cli/command.h"
#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/core/suggest.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/mesh.h"

namespace easypbr::cli {
namespace {

StyleOption parse_style(const std::string& text) {
    const size_t equals = text.find('=');
    if (equals == text.npos || equals == 0)
        throw UsageError(fmt::format("--style: expected KEY=VALUE or NAME.KEY=VALUE, got '{}'", text));
    const std::string target = text.substr(0, equals);
    const size_t dot = target.rfind('.');  // names of files may have dots, keys have none
    StyleOption option;
    if (dot != target.npos) option.object = target.substr(0, dot);
    option.key = dot == target.npos ? target : target.substr(dot + 1);
    option.value = text.substr(equals + 1);
    return option;
}

void check(const StyleOption& option, const std::vector<std::string>& names) {
    try {
        Style style;
        set_from_text(style, option.key, option.value);
    } catch (const Error& error) {
        throw UsageError(fmt::format("--style: {}", error.what()));
    }
    if (option.object.empty() || std::ranges::find(names, option.object) != names.end()) return;
    throw UsageError(fmt::format("--style: there is no object '{}'{}: the files are called {}", option.object,
                                 did_you_mean(option.object, names), fmt::join(names, ", ")));
}

void for_each_mesh(Mesh mesh, const std::function<void(Mesh&)>& visit) {
    visit(mesh);
    for (const Mesh& child : mesh.snapshot()->children) for_each_mesh(child, visit);
}

}  // namespace

std::vector<StyleOption> parse_styles(const std::vector<std::string>& texts,
                                      const std::vector<std::string>& names) {
    std::vector<StyleOption> options;
    for (const std::string& text : texts) {
        options.push_back(parse_style(text));
        check(options.back(), names);
    }
    return options;
}

void style_object(const std::string& name, const std::vector<StyleOption>& styles,
                  const std::shared_ptr<const LabelMap>& label_map, const Mesh& mesh) {
    bool has_labels = false;
    for_each_mesh(mesh, [&](Mesh& node) {
        Style style = node.style();
        for (const StyleOption& option : styles)
            if (option.object == name) set_from_text(style, option.key, option.value);
        node.set_style(style);
        if (!label_map || node.L().empty()) return;
        node.set_label_map(label_map);
        has_labels = true;
    });
    if (label_map && !has_labels) log_warning(fmt::format("--label-map: '{}' has no labels", name));
}

}  // namespace easypbr::cli
