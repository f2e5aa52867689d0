// PLY files for tests, in every format and with every type, made without the library.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

/// Writes a file value by value; the header is the caller's.
class PlyBuilder {
  public:
    /// `format`: "ascii", "binary_little_endian" or "binary_big_endian".
    explicit PlyBuilder(std::string format) : format_(std::move(format)) {
        text_ = "ply\nformat " + format_ + " 1.0\n";
    }

    PlyBuilder& header(const std::string& lines) {
        text_ += lines + "\n";
        return *this;
    }
    PlyBuilder& end_header() { return header("end_header"); }

    /// One value of a type as the header spells it.
    PlyBuilder& value(std::string_view type, double v) {
        if (format_ == "ascii") {
            char digits[32];
            std::snprintf(digits, sizeof digits, "%.17g ", v);
            text_ += digits;
        } else if (type == "char" || type == "int8") {
            append(int8_t(v));
        } else if (type == "uchar" || type == "uint8") {
            append(uint8_t(v));
        } else if (type == "short" || type == "int16") {
            append(int16_t(v));
        } else if (type == "ushort" || type == "uint16") {
            append(uint16_t(v));
        } else if (type == "int" || type == "int32") {
            append(int32_t(v));
        } else if (type == "uint" || type == "uint32") {
            append(uint32_t(v));
        } else if (type == "float" || type == "float32") {
            append(float(v));
        } else {
            append(double(v));
        }
        return *this;
    }
    template <class List>
    PlyBuilder& values(std::string_view type, const List& list) {
        for (const auto v : list) value(type, double(v));
        return *this;
    }
    PlyBuilder& values(std::string_view type, std::initializer_list<double> list) {
        for (const double v : list) value(type, v);
        return *this;
    }
    PlyBuilder& end_row() {
        if (format_ == "ascii") text_ += "\n";
        return *this;
    }

    const std::string& text() const { return text_; }

  private:
    template <class T>
    void append(T v) {
        char bytes[sizeof(T)];
        std::memcpy(bytes, &v, sizeof(T));
        if (format_ == "binary_big_endian") std::reverse(bytes, bytes + sizeof(T));
        text_.append(bytes, sizeof(T));
    }

    std::string format_, text_;
};
