#include "easypbr/gui/gui.h"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cfloat>
#include <exception>
#include <set>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/hash.h"
#include "easypbr/gui/gui_scope.h"
#include "easypbr/gui/panels.h"
#include "easypbr/gui/widgets.h"

namespace easypbr::gui {
namespace {

struct Column {
    const char* id;
    std::vector<std::pair<Panel, void (*)(GuiState&)>> panels;
};

const Column left = {"##left",
                     {{Panel::scene, scene_panel},
                      {Panel::object, object_panel},
                      {Panel::animations, animations_panel},
                      {Panel::camera_path, camera_path_panel},
                      {Panel::recorder, recorder_panel}}};
const Column right = {"##right",
                      {{Panel::effects, effects_panel},
                       {Panel::lights, lights_panel},
                       {Panel::environment, environment_panel},
                       {Panel::camera, camera_panel},
                       {Panel::channels, channels_panel},
                       {Panel::statistics, statistics_panel}}};
const Panel folded[] = {Panel::lights,     Panel::environment, Panel::camera,
                        Panel::animations, Panel::camera_path, Panel::recorder};

void draw_panel(GuiState& state, Panel panel, void (*contents)(GuiState&)) {
    if (state.panels.unfold.erase(panel)) ImGui::SetNextItemOpen(true);
    const bool open = heading(panel_name(panel), std::ranges::find(folded, panel) == std::end(folded));
    note_place(panel_name(panel));
    if (!open) return;
    ImGui::PushID(panel_name(panel));
    ImGui::Spacing();
    contents(state);
    ImGui::Spacing();
    ImGui::PopID();
}

void draw_column(GuiState& state, const Column& column, float x, float top, float width) {
    const bool any =
        std::ranges::any_of(column.panels, [&](const auto& p) { return state.panels.is_open(p.first); });
    if (!any) return;
    ImGui::SetNextWindowPos(ImVec2(x, top));
    // As high as what is in it, down to the bottom of the window.
    ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0), ImVec2(width, float(state.screen.size.y()) - top));
    ImGui::SetNextWindowSize(ImVec2(width, 0));
    const ImGuiWindowFlags flags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoSavedSettings |
                                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_AlwaysAutoResize;
    if (ImGui::Begin(column.id, nullptr, flags))
        for (const auto& [panel, contents] : column.panels)
            if (state.panels.is_open(panel)) draw_panel(state, panel, contents);
    ImGui::End();
}

/// On both sides, or below each other where the window is too narrow for that.
void draw_columns(GuiState& state) {
    const float top = ImGui::GetFrameHeight(), window = float(state.screen.size.x());
    const float on_left = left_width * state.screen.scale, on_right = right_width * state.screen.scale;
    if (on_left + on_right <= window) {
        draw_column(state, left, 0, top, on_left);
        return draw_column(state, right, window - on_right, top, on_right);
    }
    Column both = left;
    both.panels.insert(both.panels.end(), right.panels.begin(), right.panels.end());
    draw_column(state, both, 0, top, std::min(std::max(on_left, on_right), window));
}

/// Over all of the window; a recording's frame as large as fits, with bars beside it.
void show_picture(const GuiState& state, const gl::Texture& picture) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    ImVec2 size = window;
    if (state.live.picture().shows_other()) {
        const float fit = std::min(window.x / float(picture.width()), window.y / float(picture.height()));
        size = ImVec2(fit * float(picture.width()), fit * float(picture.height()));
        list.AddRectFilled(ImVec2(0, 0), window, IM_COL32_BLACK);
    }
    const ImVec2 from((window.x - size.x) / 2, (window.y - size.y) / 2);
    list.AddImage(ImTextureID(intptr_t(picture.id())), from, ImVec2(from.x + size.x, from.y + size.y));
}

/// The same for frames that look the same, as long as pictures keep their contents.
std::string hash_of(const ImDrawData& data) {
    std::string hashes;
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        hashes += content_hash(std::as_bytes(std::span(list.VtxBuffer.Data, size_t(list.VtxBuffer.Size))));
        hashes += content_hash(std::as_bytes(std::span(list.IdxBuffer.Data, size_t(list.IdxBuffer.Size))));
        for (const ImDrawCmd& command : list.CmdBuffer)
            hashes += content_hash(std::as_bytes(std::span(&command, 1)));
    }
    return hashes;
}

// Nothing may be thrown through ImGui.
const char* pasted_text(void* user) {
    FieldClipboard& fields = *static_cast<FieldClipboard*>(user);
    try {
        fields.text = fields.clipboard->read();
        return fields.text.c_str();
    } catch (const std::exception& error) {
        fields.failure = error.what();
        return nullptr;
    }
}

void copy_text(void* user, const char* text) {
    FieldClipboard& fields = *static_cast<FieldClipboard*>(user);
    try {
        fields.clipboard->write(text);
    } catch (const std::exception& error) {
        fields.failure = error.what();
    }
}

/// Whether a key that goes down may change a text or what is chosen in it.
bool changes_text(const app::InputEvent& event) {
    namespace k = app::key;
    const bool modifies = event.key >= k::left_shift && event.key <= k::right_alt;
    return !modifies && (event.control || event.key >= k::escape);
}

}  // namespace

Gui::Gui() {
    const GuiScope none(nullptr);
    IMGUI_CHECKVERSION();
    context_ = ImGui::CreateContext();
    ImGui::SetCurrentContext(context_);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.UserData = &places_;
    io.ClipboardUserData = &field_clipboard_;
    io.GetClipboardTextFn = pasted_text;
    io.SetClipboardTextFn = copy_text;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    namespace k = app::key;
    const std::pair<ImGuiKey, int> keys[] = {{ImGuiKey_Tab, k::tab},
                                             {ImGuiKey_LeftArrow, k::left},
                                             {ImGuiKey_RightArrow, k::right},
                                             {ImGuiKey_UpArrow, k::up},
                                             {ImGuiKey_DownArrow, k::down},
                                             {ImGuiKey_PageUp, k::page_up},
                                             {ImGuiKey_PageDown, k::page_down},
                                             {ImGuiKey_Home, k::home},
                                             {ImGuiKey_End, k::end},
                                             {ImGuiKey_Insert, k::insert},
                                             {ImGuiKey_Delete, k::del},
                                             {ImGuiKey_Backspace, k::backspace},
                                             {ImGuiKey_Space, k::space},
                                             {ImGuiKey_Enter, k::enter},
                                             {ImGuiKey_Escape, k::escape},
                                             {ImGuiKey_A, 'A'},
                                             {ImGuiKey_C, 'C'},
                                             {ImGuiKey_V, 'V'},
                                             {ImGuiKey_X, 'X'},
                                             {ImGuiKey_Y, 'Y'},
                                             {ImGuiKey_Z, 'Z'}};
    for (const auto& [name, code] : keys) io.KeyMap[name] = code;
}

Gui::~Gui() {
    const GuiScope none(nullptr);
    ImGui::DestroyContext(context_);
}

bool Gui::over_panel(Vec2d position) const {
    return popup_ ||
           std::ranges::any_of(panels_, [&](const auto& panel) { return panel.contains(position); });
}

void Gui::take_button(const app::InputEvent& event) {
    const size_t button = size_t(event.button);
    down_[button] = event.kind == app::InputEvent::Kind::press;
    pressed_[button] |= down_[button];
}

bool Gui::take_key(const app::InputEvent& event) {
    using Kind = app::InputEvent::Kind;
    keys_.push_back(event);
    if (event.kind == Kind::key_up) return owned_keys_.erase(event.key) > 0;
    if (event.kind == Kind::text || event.repeat) return wants_keys_ || owned_keys_.contains(event.key);
    const bool closes = event.key == app::key::escape && (popup_ || active_);
    if (closes) closes_popups_ = popup_;
    const bool own = closes || wants_keys_;
    if (own)
        owned_keys_.insert(event.key);
    else
        owned_keys_.erase(event.key);
    return own;
}

bool Gui::needs_frame_before(const app::InputEvent& event) const {
    using Kind = app::InputEvent::Kind;
    const ImGuiIO& io = context_->IO;
    bool buttons = false;
    for (size_t i = 0; i < down_.size(); ++i) buttons |= pressed_[i] || io.MouseDown[i] != down_[i];
    const bool wheel = io.MouseWheel != 0 || io.MouseWheelH != 0;
    const bool moves =
        io.MousePos.x != float(event.position.x()) || io.MousePos.y != float(event.position.y());
    switch (event.kind) {
        case Kind::move:
        case Kind::release:
            return moves && (buttons || wheel);
        case Kind::leave:
            return buttons || wheel;
        case Kind::press:
            return buttons || wheel || has_keys();
        case Kind::scroll:
            return buttons || has_keys() || (moves && wheel);
        case Kind::key_down:
        case Kind::key_up:
        case Kind::text:
            return buttons;
        default:
            return false;
    }
}

bool Gui::take(const app::InputEvent& event) {
    using Kind = app::InputEvent::Kind;
    const GuiScope scope(context_);
    ImGuiIO& io = ImGui::GetIO();
    if (event.kind == Kind::leave)
        io.MousePos = ImVec2(-FLT_MAX, -FLT_MAX);
    else if (event.kind <= Kind::scroll)
        io.MousePos = ImVec2(float(event.position.x()), float(event.position.y()));
    const auto owned = std::ranges::find(owned_, event.button);
    switch (event.kind) {
        case Kind::move:
            return !owned_.empty() || (over_panel(event.position) && down_ == std::array<bool, 3>{});
        case Kind::press:
            take_button(event);
            // A key that went down before the window had the focus has no event.
            io.KeyCtrl = event.control;
            io.KeyShift = event.shift;
            io.KeyAlt = event.alt;
            if (over_panel(event.position)) owned_.push_back(event.button);
            return over_panel(event.position);
        case Kind::release: {
            take_button(event);
            const bool own = owned != owned_.end();
            if (own) owned_.erase(owned);
            return own;
        }
        case Kind::scroll:
            io.MouseWheel += float(event.scroll.y());
            io.MouseWheelH += float(event.scroll.x());
            return over_panel(event.position);
        case Kind::key_down:
        case Kind::key_up:
        case Kind::text:
            return take_key(event);
        case Kind::focus_lost:
            down_ = pressed_ = {};
            keys_.clear();
            io.ClearInputKeys();
            owned_.clear();
            owned_keys_.clear();
            return false;
        default:
            return false;
    }
}

void Gui::forget_device() {
    renderer_.forget_device();
    font_scale_ = 0;
}

void Gui::prepare(const GuiState& state, double seconds) {
    ImGuiIO& io = ImGui::GetIO();
    if (font_scale_ != state.screen.scale) {
        io.Fonts->Clear();
        add_font(*io.Fonts, state.screen.scale);
        renderer_.make_font_texture(*io.Fonts);
        font_scale_ = state.screen.scale;
    }
    if (theme_ != state.screen.theme || theme_scale_ != state.screen.scale) {
        apply_theme(state.screen.theme, state.screen.scale);
        theme_ = state.screen.theme;
        theme_scale_ = state.screen.scale;
    }
    io.DisplaySize = ImVec2(float(state.screen.size.x()), float(state.screen.size.y()));
    io.DeltaTime = float(std::max(seconds, 1e-4));
}

void Gui::hand_over_input() {
    ImGuiIO& io = ImGui::GetIO();
    for (size_t i = 0; i < down_.size(); ++i) {
        const bool pressed = std::exchange(pressed_[i], false);
        io.MouseDown[i] = down_[i] || pressed;
    }
    hand_over_keys();
}

void Gui::hand_over_keys() {
    using Kind = app::InputEvent::Kind;
    ImGuiIO& io = ImGui::GetIO();
    std::set<int> released;
    bool is_last = false, typed = false;
    for (; !is_last && !keys_.empty(); keys_.pop_front()) {
        const app::InputEvent& event = keys_.front();
        const bool is_key = event.kind != Kind::text, down = event.kind == Kind::key_down;
        const bool known = is_key && event.key >= 0 && event.key < int(std::size(io.KeysDown));
        const bool changes = known && io.KeysDown[event.key] != down;
        is_last = changes && down && changes_text(event);
        // A key that is down before and after is not pressed for ImGui, and letters are none with Control.
        if ((is_last && released.contains(event.key)) || (typed && event.control)) return;
        if (changes && !down) released.insert(event.key);
        if (known) io.KeysDown[event.key] = down;
        if (!is_key) io.AddInputCharacter(event.code);
        typed |= !is_key;
        io.KeyCtrl = event.control;
        io.KeyShift = event.shift;
        io.KeyAlt = event.alt;
    }
}

float Gui::menu_height(const GuiState& state) {
    if (!state.panels.shown) return 0;
    const GuiScope scope(context_);
    prepare(state, 0);
    return ImGui::GetIO().Fonts->Fonts[0]->FontSize + 2 * ImGui::GetStyle().FramePadding.y;
}

void Gui::draw_panels(GuiState& state, const std::function<void()>& more) {
    state.image_value.clear();
    if (state.panels.shown) {
        draw_path(state);
        draw_handles(state);
        menu_bar(state);
        draw_columns(state);
        status_line(state);
    }
    if (more) more();
    keys_window(state);
}

void Gui::tell(GuiState& state, const std::string& failure) {
    // What fails in every frame is told once.
    if (!failure.empty() && failure != failure_) state.notify(failure, true);
    failure_ = failure;
}

bool Gui::lay_out(GuiState& state, double seconds, const gl::Texture& picture,
                  const std::function<void()>& more) {
    const GuiScope scope(context_);
    prepare(state, seconds);
    hand_over_input();
    field_clipboard_.clipboard = &state.live.clipboard();
    places_.clear();
    ImGui::NewFrame();
    if (std::exchange(closes_popups_, false) && !ImGui::GetCurrentContext()->OpenPopupStack.empty())
        ImGui::ClosePopupToLevel(0, true);
    if (picture) show_picture(state, picture);
    std::exception_ptr other;
    std::string failure;
    try {
        draw_panels(state, more);
    } catch (const Error& error) {
        failure = error.what();
    } catch (...) {
        other = std::current_exception();
    }
    // What was begun is ended, so that the next frame is drawn as ever.
    if (other || !failure.empty()) ImGui::ErrorCheckEndFrameRecover(nullptr);
    tell(state, failure);
    if (!field_clipboard_.failure.empty()) state.notify(std::exchange(field_clipboard_.failure, {}), true);
    notifications(state);
    ImGui::Render();
    if (other) std::rethrow_exception(other);
    panels_.clear();
    for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
        if (window->Active && window->RootWindow == window &&
            !(window->Flags & ImGuiWindowFlags_NoMouseInputs))
            panels_.emplace_back(Vec2d(window->Pos.x, window->Pos.y),
                                 Vec2d(window->Pos.x + window->Size.x, window->Pos.y + window->Size.y));
    popup_ = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
    active_ = ImGui::IsAnyItemActive();
    // ImGui's own WantTextInput follows in the next frame.
    wants_keys_ = active_ && context_->WantTextInputNextFrame == 1;
    return std::exchange(laid_out_, hash_of(*ImGui::GetDrawData())) != laid_out_;
}

void Gui::paint(const gl::Framebuffer& target) {
    const GuiScope scope(context_);
    renderer_.draw(*ImGui::GetDrawData(), target);
}

}  // namespace easypbr::gui
