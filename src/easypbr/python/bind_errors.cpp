// The library's exceptions become the Python classes of easypbr/errors.py.
#include "easypbr/core/error.h"
#include "easypbr/python/bindings.h"

namespace easypbr::python {
namespace {

void raise(const char* name, const std::exception& error) {
    PyErr_SetString(nb::module_::import_("easypbr.errors").attr(name).ptr(), error.what());
}

void translate(const std::exception_ptr& pointer, void*) {
    try {
        std::rethrow_exception(pointer);
    } catch (const FileError& error) {
        raise("FileError", error);
    } catch (const FormatError& error) {
        raise("FormatError", error);
    } catch (const ArgumentError& error) {
        raise("ArgumentError", error);
    } catch (const NameError& error) {
        raise("UnknownNameError", error);
    } catch (const ShaderError& error) {
        raise("ShaderError", error);
    } catch (const ContextError& error) {
        raise("ContextError", error);
    } catch (const Error& error) {
        raise("Error", error);
    }
}

}  // namespace

void bind_errors() {
    nb::register_exception_translator(translate);
}

}  // namespace easypbr::python
