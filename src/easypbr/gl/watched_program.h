// A program whose shader files may change while it is used.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "easypbr/gl/program.h"

namespace easypbr::gl {

/// Compiles its shaders at the first use, and again when a file on disk that they are made of has changed.
/// Used by one thread at a time. What is compiled is of the context that used it last.
class WatchedProgram {
  public:
    /// As Program takes them; nothing is compiled yet. Throws FileError when a file cannot be read.
    WatchedProgram(std::string vertex, std::string fragment, ShaderTexts texts = {});

    /// The program of the files as they are now. Throws as Program does, at each call until the files have
    /// been mended.
    const Program& get(const std::vector<std::string>& defines = {});

    /// Another number whenever the files have changed.
    uint64_t revision() const;

  private:
    void note_files();

    std::string vertex_, fragment_;
    ShaderTexts texts_;
    std::vector<std::filesystem::path> files_;
    uint64_t revision_ = 0;  ///< of what is compiled
    std::map<std::vector<std::string>, Program> programs_;
    std::weak_ptr<DeletionQueue> context_;  ///< that they are of
};

}  // namespace easypbr::gl
