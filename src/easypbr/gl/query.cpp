#include "easypbr/gl/query.h"

#include <epoxy/gl.h>

namespace easypbr::gl {

OcclusionQuery OcclusionQuery::make() {
    OcclusionQuery query;
    query.object_ = Object(ObjectKind::query, GL_ANY_SAMPLES_PASSED);
    return query;
}

void OcclusionQuery::begin() const {
    glBeginQuery(GL_ANY_SAMPLES_PASSED, object_.id());
}

void OcclusionQuery::end() const {
    glEndQuery(GL_ANY_SAMPLES_PASSED);
}

bool OcclusionQuery::any_drawn() const {
    GLuint drawn = 0;
    glGetQueryObjectuiv(object_.id(), GL_QUERY_RESULT, &drawn);
    return drawn != 0;
}

}  // namespace easypbr::gl
