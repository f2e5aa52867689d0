// Images beside the scene: what a program computes, in windows with zoom, values and ranges.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "easypbr/core/image.h"
#include "easypbr/gl/texture.h"
#include "easypbr/gui/shown_image.h"
#include "easypbr/gui/state.h"

namespace easypbr::gui {

/// Pixels of a side of an image: what every driver has textures of.
inline constexpr int most_image_side = 16384;

/// Throws ArgumentError for an empty name or image, one of more than most_image_side pixels in a row or
/// column, two channels, and an empty range.
void check_panel_image(const std::string& name, const Image& image, const ImageLook& look);

/// The windows.
class ImagePanels {
  public:
    /// Shows an image of 1, 3 or 4 channels; one of the same name is replaced, in the same window, with the
    /// range and the colours that a person chose there. Throws as check_panel_image().
    void show(const std::string& name, Image image, const ImageLook& look = {});
    /// Throws NameError when there is none.
    void remove(const std::string& name);
    std::vector<std::string> names() const;
    /// Throws NameError.
    const Image& image(const std::string& name) const;

    /// What was uploaded is gone with its context, and is uploaded again.
    void forget_device();

    /// Draws the windows that are open, between ImGui's beginning and end of a frame. The context must be
    /// current.
    void draw(GuiState& state);
    void menu();

  private:
    struct Panel {
        Image image;
        ImageLook given, look;  ///< by the program, and as a person changed it
        gl::Texture texture;
        bool stale = true, open = true;
        float zoom = 0;  ///< pixels of the screen for one of the image; 0: as fits
        Vec2 centre{0, 0};
    };
    const Panel& find(const std::string& name) const;
    void draw_panel(GuiState& state, const std::string& name, Panel& panel);
    void draw_canvas(GuiState& state, const std::string& name, Panel& panel);

    std::map<std::string, Panel> panels_;
    float scale_ = 0;
};

}  // namespace easypbr::gui
