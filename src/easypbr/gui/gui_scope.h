// Turns at Dear ImGui, which serves one thread at a time and has one current context.
#pragma once

#include <imgui.h>

#include <mutex>

namespace easypbr::gui {

inline std::recursive_mutex& imgui_mutex() {
    static std::recursive_mutex mutex;
    return mutex;
}

/// Makes a context ImGui's own for a scope, and gives back another one that was.
class GuiScope {
  public:
    explicit GuiScope(ImGuiContext* context) : lock_(imgui_mutex()), previous_(ImGui::GetCurrentContext()) {
        ImGui::SetCurrentContext(context);
    }
    ~GuiScope() { ImGui::SetCurrentContext(previous_); }
    GuiScope(const GuiScope&) = delete;
    GuiScope& operator=(const GuiScope&) = delete;

  private:
    std::lock_guard<std::recursive_mutex> lock_;
    ImGuiContext* previous_;
};

/// Within one GuiScope: lets other threads have their turn while a user's code runs. That code may wait for
/// whatever it likes, another viewer for example that waits for ImGui.
class GuiPause {
  public:
    GuiPause() : context_(ImGui::GetCurrentContext()) {
        ImGui::SetCurrentContext(nullptr);
        imgui_mutex().unlock();
    }
    ~GuiPause() {
        imgui_mutex().lock();
        ImGui::SetCurrentContext(context_);
    }
    GuiPause(const GuiPause&) = delete;
    GuiPause& operator=(const GuiPause&) = delete;

    ImGuiContext* context() const { return context_; }

  private:
    ImGuiContext* context_;
};

}  // namespace easypbr::gui
