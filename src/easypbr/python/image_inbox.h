// Images for a viewer that is busy.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "easypbr/gui/image_panels.h"
#include "easypbr/viewer/viewer.h"

namespace easypbr::python {

/// The newest image of each name waits for the viewer's next turn. put() may be called on any thread.
class ImageInbox {
  public:
    /// Throws ArgumentError for what ImagePanels::show() refuses.
    void put(const std::string& name, Image image, const gui::ImageLook& look) {
        gui::check_panel_image(name, image, look);
        const std::lock_guard lock(mutex_);
        images_.insert_or_assign(name, std::pair(std::move(image), look));
    }

    /// For whoever has the turn.
    void deliver(Viewer& viewer) {
        std::map<std::string, std::pair<Image, gui::ImageLook>> images;
        {
            const std::lock_guard lock(mutex_);
            images.swap(images_);
        }
        for (auto& [name, shown] : images) viewer.show_image(name, std::move(shown.first), shown.second);
    }

  private:
    std::mutex mutex_;
    std::map<std::string, std::pair<Image, gui::ImageLook>> images_;
};

}  // namespace easypbr::python
