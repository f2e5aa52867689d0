// Compiled variants of a shader pair, by their macros.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "easypbr/gl/program.h"

namespace easypbr::render {

class ProgramVariants {
  public:
    ProgramVariants(std::string vertex, std::string fragment)
        : vertex_(std::move(vertex)), fragment_(std::move(fragment)) {}

    /// The program compiled with these macros; compiled at the first call.
    const gl::Program& get(const std::vector<std::string>& defines) {
        gl::Program& program = programs_[defines];
        if (!program) program = gl::Program(vertex_, fragment_, defines);
        return program;
    }

    /// Forgets all programs, so that changed shader files are read again.
    void clear() { programs_.clear(); }

  private:
    std::string vertex_, fragment_;
    std::map<std::vector<std::string>, gl::Program> programs_;
};

}  // namespace easypbr::render
