// Compiled variants of a shader pair, by their macros.
#pragma once

#include <map>
#include <string>
#include <utility>
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

    /// The same with texts in place of shader files; `text_key` says which they are.
    const gl::Program& get(const std::vector<std::string>& defines, const std::string& text_key,
                           const gl::ShaderTexts& texts) {
        gl::Program& program = with_texts_[{defines, text_key}];
        if (!program) program = gl::Program(vertex_, fragment_, defines, texts);
        return program;
    }
    /// Forgets the programs with texts when they are more than a scene could have: texts come and go.
    void limit_texts(size_t count) {
        if (with_texts_.size() > count) with_texts_.clear();
    }

    /// Forgets all programs, so that changed shader files are read again.
    void clear() {
        programs_.clear();
        with_texts_.clear();
    }

  private:
    std::string vertex_, fragment_;
    std::map<std::vector<std::string>, gl::Program> programs_;
    std::map<std::pair<std::vector<std::string>, std::string>, gl::Program> with_texts_;
};

}  // namespace easypbr::render
