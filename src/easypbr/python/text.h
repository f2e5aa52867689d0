// std::string to and from Python's str. A name may come from a file that is not UTF-8: its bytes become lone
// surrogates and back, as in Python's own file names (PEP 383). Stands in for nanobind/stl/string.h, which
// raises.
#pragma once

#include <nanobind/nanobind.h>

#include <string>

namespace nanobind::detail {

template <>
struct type_caster<std::string> {
    NB_TYPE_CASTER(std::string, const_name("str"))

    bool from_python(handle source, uint32_t, cleanup_list*) noexcept {
        if (!PyUnicode_Check(source.ptr())) return false;
        Py_ssize_t size = 0;
        if (const char* text = PyUnicode_AsUTF8AndSize(source.ptr(), &size)) {
            value.assign(text, size_t(size));
            return true;
        }
        PyErr_Clear();
        const object bytes = steal(PyUnicode_AsEncodedString(source.ptr(), "utf-8", "surrogateescape"));
        if (!bytes.is_valid()) {
            PyErr_Clear();
            return false;
        }
        value.assign(PyBytes_AsString(bytes.ptr()), size_t(PyBytes_Size(bytes.ptr())));
        return true;
    }

    static handle from_cpp(const std::string& text, rv_policy, cleanup_list*) noexcept {
        return PyUnicode_DecodeUTF8(text.data(), Py_ssize_t(text.size()), "surrogateescape");
    }
};

}  // namespace nanobind::detail
