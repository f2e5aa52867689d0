#pragma once
#include <filesystem>
#include <string>

namespace easypbr::io {

/// Where a file beside libeasypbr.so stands; empty where the system does not say where that is.
std::filesystem::path beside_library(const char* file_name);

/// A part of the library that is loaded at run time, because it needs what not every machine has. It is found
/// beside libeasypbr.so or where the system looks, and is never unloaded: its exceptions may outlive a call.
class RuntimeModule {
  public:
    explicit RuntimeModule(const char* file_name);

    /// Sets the function of that name; none: reason() says that the module is of another version.
    template <class Function>
    void find(Function*& function, const char* name) {
        function = reinterpret_cast<Function*>(symbol(name));
    }

    /// Why the module cannot be used; empty: it can.
    const std::string& reason() const { return reason_; }

  private:
    void* symbol(const char* name);

    const char* file_name_;
    void* handle_ = nullptr;
    std::string reason_;
};

}  // namespace easypbr::io
