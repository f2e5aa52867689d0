// Exceptions of the library. Each message says what was expected, what came, where, and what to do.
#pragma once

#include <stdexcept>
#include <string>

// Containers of libstdc++'s debug mode have another layout, and so have types with a std::vector. All headers
// that have one include this. The CMake target and easypbr.pc of a library in this mode define both.
#if defined(_GLIBCXX_DEBUG) && !defined(EASYPBR_GLIBCXX_DEBUG)
#error "EasyPBR: compile without _GLIBCXX_DEBUG, as the library is; _GLIBCXX_ASSERTIONS may be defined"
#endif

namespace easypbr {

/// Base of every exception that the library throws.
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// A file or folder cannot be opened, read or written. Python: OSError.
class FileError : public Error {
  public:
    using Error::Error;
};

/// A file's content is damaged, or is of a kind that is not understood. Python: ValueError.
class FormatError : public Error {
  public:
    using Error::Error;
};

/// A value given by the caller is out of range, of the wrong shape or unknown. Python: ValueError.
class ArgumentError : public Error {
  public:
    using Error::Error;
};

/// A named thing (mesh, light, setting) does not exist. Python: KeyError.
class NameError : public Error {
  public:
    using Error::Error;
};

/// A program's own shader text does not compile, at the line that the message names. Python: ValueError.
class ShaderError : public Error {
  public:
    using Error::Error;
};

/// No OpenGL context could be made, or a GL limit was met. Python: RuntimeError.
class ContextError : public Error {
  public:
    using Error::Error;
};

}  // namespace easypbr
