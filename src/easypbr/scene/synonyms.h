// What other programs and libraries call a setting: the one list for the command line and for Python.
#pragma once

#include <span>
#include <string_view>

namespace easypbr {

/// A word of F3D, PyVista, Open3D, Polyscope, Blender or the first EasyPBR.
struct Synonym {
    std::string_view word;
    std::string_view setting;  ///< what it is called here; empty: it is no setting
    std::string_view advice;   ///< where it is none: what to do instead, in Python
    std::string_view option;   ///< and on the command line
};

/// All of them, in alphabetical order of the words.
std::span<const Synonym> synonyms();

/// What a word means, in lower case or not, with "-" for "_" or not; null: nothing.
const Synonym* synonym(std::string_view word);

}  // namespace easypbr
