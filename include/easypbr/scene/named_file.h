// NamedFile: a setting that names a file.
#pragma once

#include <string>

namespace easypbr {

/// The name of a file as it was given, and the file that it meant then: a relative name is that of a file in
/// the folder that was the working folder when the name was assigned. Assign and read it like a string;
/// copies mean the same file.
class NamedFile {
  public:
    NamedFile() = default;
    NamedFile(std::string name);
    NamedFile(const char* name) : NamedFile(std::string(name)) {}

    /// As it was given; empty: no file.
    const std::string& name() const { return name_; }
    operator const std::string&() const { return name_; }
    bool empty() const { return name_.empty(); }
    void clear() { *this = NamedFile(); }

    /// The absolute path; empty where no file is named.
    const std::string& path() const { return path_; }
    /// A path to open it by, which messages may hold: the name, unless the working folder is another one than
    /// that it was given in; then the absolute path.
    const std::string& path_from_here() const;

    /// Whether the names and what they mean are the same.
    bool operator==(const NamedFile&) const = default;
    /// Compares the name.
    bool operator==(const std::string& name) const { return name_ == name; }
    bool operator==(const char* name) const { return name_ == name; }

  private:
    std::string name_, path_;
};

}  // namespace easypbr
