#include "easypbr/gui/theme.h"

#include <imgui.h>

#include "easypbr/app/font.h"

namespace easypbr::gui {
namespace {

struct Palette {
    ImVec4 panel, header, frame, hovered, active, text, dim, border, accent;
};

ImVec4 rgb(int code, float alpha = 1) {
    return {float(code >> 16 & 255) / 255, float(code >> 8 & 255) / 255, float(code & 255) / 255, alpha};
}

Palette palette_of(Theme theme) {
    if (theme == Theme::light)
        return {rgb(0xf4f5f7, 0.96f), rgb(0xdfe3ea), rgb(0xffffff), rgb(0xe3ebf8), rgb(0xcfdef6),
                rgb(0x1e2530),        rgb(0x6b7480), rgb(0xc4cad3), rgb(0x2f6fd6)};
    return {rgb(0x1b1e23, 0.94f), rgb(0x2a2f37), rgb(0x292d34), rgb(0x363c46), rgb(0x404956),
            rgb(0xe4e7eb),        rgb(0x8d96a3), rgb(0x353b45), rgb(0x5b9bf2)};
}

void apply_colors(const Palette& p, ImVec4 (&c)[ImGuiCol_COUNT]) {
    const ImVec4 faint(p.accent.x, p.accent.y, p.accent.z, 0.35f);
    const ImVec4 clear(0, 0, 0, 0);
    c[ImGuiCol_Text] = p.text;
    c[ImGuiCol_TextDisabled] = p.dim;
    c[ImGuiCol_WindowBg] = c[ImGuiCol_MenuBarBg] = p.panel;
    c[ImGuiCol_PopupBg] = ImVec4(p.panel.x, p.panel.y, p.panel.z, 1);
    c[ImGuiCol_ChildBg] = clear;
    c[ImGuiCol_Border] = c[ImGuiCol_Separator] = c[ImGuiCol_TableBorderLight] = p.border;
    c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgActive] = c[ImGuiCol_TitleBgCollapsed] = p.header;
    c[ImGuiCol_Header] = p.header;
    c[ImGuiCol_HeaderHovered] = p.hovered;
    c[ImGuiCol_HeaderActive] = p.active;
    c[ImGuiCol_FrameBg] = c[ImGuiCol_Button] = p.frame;
    c[ImGuiCol_FrameBgHovered] = c[ImGuiCol_ButtonHovered] = p.hovered;
    c[ImGuiCol_FrameBgActive] = c[ImGuiCol_ButtonActive] = p.active;
    c[ImGuiCol_CheckMark] = c[ImGuiCol_SliderGrabActive] = p.accent;
    // The number stands over the grab and has to stay readable.
    c[ImGuiCol_SliderGrab] = ImVec4(p.accent.x, p.accent.y, p.accent.z, 0.55f);
    c[ImGuiCol_PlotHistogram] = c[ImGuiCol_PlotLines] = p.accent;
    c[ImGuiCol_TextSelectedBg] = faint;
    c[ImGuiCol_ScrollbarBg] = clear;
    c[ImGuiCol_ScrollbarGrab] = p.border;
    c[ImGuiCol_ScrollbarGrabHovered] = c[ImGuiCol_ScrollbarGrabActive] = p.dim;
    c[ImGuiCol_ResizeGrip] = clear;
    c[ImGuiCol_Tab] = p.header;
    c[ImGuiCol_TabHovered] = p.hovered;
    c[ImGuiCol_TabActive] = p.active;
}

}  // namespace

void apply_theme(Theme theme, float scale) {
    ImGuiStyle style;
    if (theme == Theme::light)
        ImGui::StyleColorsLight(&style);
    else
        ImGui::StyleColorsDark(&style);
    apply_colors(palette_of(theme), style.Colors);
    style.WindowPadding = ImVec2(10, 8);
    style.FramePadding = ImVec2(7, 3);
    style.ItemSpacing = ImVec2(8, 5);
    style.ItemInnerSpacing = ImVec2(6, 4);
    style.CellPadding = ImVec2(4, 2);
    style.IndentSpacing = 14;
    style.ScrollbarSize = 11;
    style.GrabMinSize = 9;
    style.WindowRounding = 0;
    style.PopupRounding = style.FrameRounding = style.GrabRounding = style.ScrollbarRounding = 4;
    style.WindowBorderSize = 0;
    style.FrameBorderSize = theme == Theme::light ? 1.0f : 0.0f;
    style.WindowMenuButtonPosition = ImGuiDir_None;
    style.ScaleAllSizes(scale);
    ImGui::GetStyle() = style;
}

void add_font(ImFontAtlas& atlas, float scale) {
    static const ImWchar ranges[] = {0x20,   0xff,   0x100,  0x17f,  0x370,  0x3ff,  0x400,
                                     0x4ff,  0x2010, 0x205e, 0x2190, 0x21ff, 0x2200, 0x22ff,
                                     0x25a0, 0x26ff, 0x2713, 0x2717, 0};
    // What stands for characters that the font lacks; a question mark would be read as one.
    constexpr ImWchar white_square = 0x25a1;
    ImFontConfig config;
    config.FontDataOwnedByAtlas = false;
    config.OversampleH = 2;
    config.PixelSnapH = true;
    const auto file = app::font_file();
    // ImGui takes a pointer that is not constant and only reads.
    void* data = const_cast<std::byte*>(file.data());
    ImFont* font = atlas.AddFontFromMemoryTTF(data, int(file.size()), 14 * scale, &config, ranges);
    font->FallbackChar = white_square;
}

}  // namespace easypbr::gui
