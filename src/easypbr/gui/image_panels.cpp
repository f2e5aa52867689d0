#include "easypbr/gui/image_panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/suggest.h"
#include "easypbr/gui/widgets.h"

namespace easypbr::gui {
namespace {

constexpr float image_panel_width = 240, gap = 12, largest_zoom = 64;
/// From this zoom on pixels are seen as squares.
constexpr float square_zoom = 2;

std::string value_text(const Image& image, int x, int y) {
    std::string text = fmt::format("({}, {})", x, y);
    for (int c = 0; c < image.channels(); ++c)
        if (image.type() == PixelType::u8)
            text += fmt::format("  {}", image.at<uint8_t>(x, y)[c]);
        else if (image.type() == PixelType::u16)
            text += fmt::format("  {}", image.at<uint16_t>(x, y)[c]);
        else
            text += fmt::format("  {:.4g}", image.at<float>(x, y)[c]);
    return text;
}

/// One window's canvas on the screen.
struct Canvas {
    ImVec2 from, size;
    Vec2 centre;  ///< the image's pixel in the middle
    float zoom;

    Vec2 pixel_at(ImVec2 p) const {
        return centre + Vec2(p.x - from.x - size.x / 2, p.y - from.y - size.y / 2) / zoom;
    }
    ImVec2 place_of(float x, float y) const {
        return ImVec2(from.x + size.x / 2 + (x - centre.x()) * zoom,
                      from.y + size.y / 2 + (y - centre.y()) * zoom);
    }
};

bool look_rows(const Image& image, ImageLook& look) {
    if (image.type() == PixelType::u8 && image.channels() > 1) return false;
    bool changed = false;
    const ValueRange range = range_of(image, look);
    const float width = ImGui::GetContentRegionAvail().x, space = ImGui::GetStyle().ItemSpacing.x;
    const bool one = image.channels() == 1;
    const float half = one ? (width - space) / 2 : width;
    if (one) {
        ImGui::SetNextItemWidth(half);
        if (ImGui::BeginCombo("##colormap", colormap_of(image, look).text().c_str())) {
            for (const std::string& name : colormap_names())
                if (ImGui::Selectable(name.c_str())) {
                    look.colormap = parse_colormap(name);
                    changed = true;
                }
            ImGui::EndCombo();
        }
        ImGui::SameLine();
    }
    float low = range.min, high = range.max;
    ImGui::SetNextItemWidth(half);
    const float speed = std::max((range.data_max - range.data_min) * 0.005f, 1e-6f);
    if (ImGui::DragFloatRange2("##range", &low, &high, speed, 0, 0, "%.3g", "%.3g") && low < high) {
        look.min = low;
        look.max = high;
        changed = true;
    }
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("Values shown as the first and the last colour; a right click shows all");
    if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) {
        look.min.reset();
        look.max.reset();
        changed = true;
    }
    return changed;
}

}  // namespace

void check_panel_image(const std::string& name, const Image& image, const ImageLook& look) {
    if (name.empty()) throw ArgumentError("an image needs a name");
    if (image.empty()) throw ArgumentError(fmt::format("image '{}' is empty", name));
    if (std::max(image.width(), image.height()) > most_image_side)
        throw ArgumentError(fmt::format("image '{}': expected {} x {} pixels at most, got {} x {}", name,
                                        most_image_side, most_image_side, image.width(), image.height()));
    if (image.channels() == 2)
        throw ArgumentError(fmt::format("image '{}': expected 1, 3 or 4 channels, got 2", name));
    const auto wrong = [](const std::optional<float>& value) { return value && !std::isfinite(*value); };
    if (wrong(look.min) || wrong(look.max) || (look.min && look.max && !(*look.min < *look.max)))
        throw ArgumentError(fmt::format("image '{}': expected a range from low to high", name));
}

void ImagePanels::show(const std::string& name, Image image, const ImageLook& look) {
    check_panel_image(name, image, look);
    Panel& panel = panels_[name];
    // What a person chose stays until the program wants something else than before.
    const bool same =
        panel.given.min == look.min && panel.given.max == look.max && panel.given.colormap == look.colormap;
    if (!same || panel.image.empty()) panel.look = look;
    if (panel.image.width() != image.width() || panel.image.height() != image.height()) panel.zoom = 0;
    panel.given = look;
    panel.image = std::move(image);
    panel.stale = true;
}

void ImagePanels::remove(const std::string& name) {
    find(name);
    panels_.erase(name);
}

std::vector<std::string> ImagePanels::names() const {
    std::vector<std::string> names;
    for (const auto& [name, panel] : panels_) names.push_back(name);
    return names;
}

const ImagePanels::Panel& ImagePanels::find(const std::string& name) const {
    const auto found = panels_.find(name);
    if (found == panels_.end())
        throw NameError(fmt::format("no image '{}'{}", name, did_you_mean(name, names())));
    return found->second;
}

const Image& ImagePanels::image(const std::string& name) const {
    return find(name).image;
}

void ImagePanels::forget_device() {
    for (auto& [name, panel] : panels_) {
        panel.texture = gl::Texture();
        panel.stale = true;
    }
}

void ImagePanels::draw(GuiState& state) {
    const bool rescaled = std::exchange(scale_, state.screen.scale) != state.screen.scale;
    const float step = (image_panel_width + gap) * state.screen.scale,
                left = (left_width + gap) * state.screen.scale;
    const float right = float(state.screen.size.x()) - right_width * state.screen.scale;
    float x = left, bottom = float(state.screen.size.y()) - gap * state.screen.scale;
    for (auto& [name, panel] : panels_) {
        if (!panel.open) continue;
        const float width = image_panel_width * state.screen.scale;
        const float shape = float(panel.image.height()) / float(panel.image.width());
        const float rows = 2.2f * ImGui::GetFrameHeightWithSpacing() + ImGui::GetFrameHeight();
        const float height = std::clamp(width * shape, 0.3f * width, 1.5f * width) + rows;
        if (x + width > right && x > left) {
            x = left;
            bottom -= height + gap * state.screen.scale;
        }
        const ImGuiCond when = rescaled ? ImGuiCond_Always : ImGuiCond_FirstUseEver;
        ImGui::SetNextWindowPos(ImVec2(x, std::max(bottom - height, ImGui::GetFrameHeight())), when);
        ImGui::SetNextWindowSize(ImVec2(width, height), when);
        draw_panel(state, name, panel);
        x += step;
    }
}

void ImagePanels::draw_panel(GuiState& state, const std::string& name, Panel& panel) {
    const ImGuiWindowFlags flags =
        ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoScrollbar;
    if (ImGui::Begin((name + "##image").c_str(), &panel.open, flags)) {
        panel.stale |= look_rows(panel.image, panel.look);
        if (panel.stale) {
            const Image shown = shown_image(panel.image, panel.look);
            if (!panel.texture || panel.texture.width() != shown.width() ||
                panel.texture.height() != shown.height())
                panel.texture = gl::Texture(gl::Format::rgba8, shown.width(), shown.height());
            panel.texture.upload(shown.bytes());
            panel.stale = false;
        }
        draw_canvas(state, name, panel);
    }
    ImGui::End();
}

void ImagePanels::draw_canvas(GuiState& state, const std::string& name, Panel& panel) {
    const Image& image = panel.image;
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const ImVec2 size(std::max(room.x, 8.0f), std::max(room.y - ImGui::GetTextLineHeightWithSpacing(), 8.0f));
    Canvas canvas{ImGui::GetCursorScreenPos(), size, panel.centre, panel.zoom};
    const float fit = std::min(size.x / float(image.width()), size.y / float(image.height()));
    if (canvas.zoom <= 0) {
        canvas.zoom = fit;
        canvas.centre = Vec2(float(image.width()), float(image.height())) / 2;
    }
    ImGui::InvisibleButton("canvas", size);
    note_place(name);
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsItemActive() && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
        panel.centre = canvas.centre -= Vec2(io.MouseDelta.x, io.MouseDelta.y) / canvas.zoom;
        panel.zoom = canvas.zoom;
    }
    const bool hovered = ImGui::IsItemHovered();
    if (hovered && io.MouseWheel != 0) {
        const Vec2 pixel = canvas.pixel_at(io.MousePos);
        const float zoom = std::clamp(canvas.zoom * std::pow(1.25f, io.MouseWheel), fit / 4, largest_zoom);
        panel.centre = canvas.centre = pixel + (canvas.centre - pixel) * (canvas.zoom / zoom);
        panel.zoom = canvas.zoom = zoom;
    }
    if (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) panel.zoom = 0;
    panel.texture.sampling(canvas.zoom >= square_zoom ? gl::Filtering::nearest : gl::Filtering::linear);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 to(canvas.from.x + size.x, canvas.from.y + size.y);
    list.PushClipRect(canvas.from, to, true);
    list.AddImage(ImTextureID(intptr_t(panel.texture.id())), canvas.place_of(0, 0),
                  canvas.place_of(float(image.width()), float(image.height())));
    list.PopClipRect();
    const Vec2 pixel = canvas.pixel_at(io.MousePos);
    const int x = int(std::floor(pixel.x())), y = int(std::floor(pixel.y()));
    const bool inside = hovered && x >= 0 && y >= 0 && x < image.width() && y < image.height();
    dim_text(inside ? value_text(image, x, y)
                    : fmt::format("{} x {}   {:.0f} %", image.width(), image.height(), 100 * canvas.zoom));
    if (inside) state.image_value = fmt::format("{}: {}", name, value_text(image, x, y));
}

void ImagePanels::menu() {
    if (panels_.empty()) return;
    ImGui::Separator();
    for (auto& [name, panel] : panels_) ImGui::MenuItem(name.c_str(), nullptr, &panel.open);
}

}  // namespace easypbr::gui
