// The library's exceptions become the Python classes of easypbr/errors.py.
#include <typeinfo>

#include "easypbr/core/error.h"
#include "easypbr/python/bindings.h"
#include "easypbr/python/text.h"

namespace easypbr::python {
namespace {

void raise(const char* name, const std::exception& error) {
    // A message may hold the name of a file that is not UTF-8.
    const nb::object type = nb::module_::import_("easypbr.errors").attr(name);
    PyErr_SetObject(type.ptr(), nb::cast(std::string(error.what())).ptr());
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
    } catch (const std::bad_cast&) {
        PyErr_SetString(PyExc_TypeError, "a value is of another type than expected");
    }
}

}  // namespace

void bind_errors() {
    nb::register_exception_translator(translate);
}

}  // namespace easypbr::python
