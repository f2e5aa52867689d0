// Pictures of lines from above.
#pragma once

#include "render_test.h"

namespace easypbr::render {

/// Seen along -z; the square of half width 1 about the origin fills the picture.
inline app::Session looking_down(const Scene& scene, int size) {
    app::Session session = plain_session(scene, size);
    session.settings().camera.projection = Projection::orthographic;
    session.settings().camera.ortho_height = 2.0;
    look_from(session, Vec3d(0, 0, 4));
    return session;
}

/// Of all pixels.
inline double sum_of_alpha(const Image& image) {
    double sum = 0;
    for (size_t i = 3; i < image.pixels<float>().size(); i += 4) sum += double(image.pixels<float>()[i]);
    return sum;
}

}  // namespace easypbr::render
