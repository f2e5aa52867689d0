// Binary files for tests, value by value, little-endian; made without the library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <span>
#include <string>

class Bytes {
  public:
    template <class T>
    Bytes& add(T value) {
        char bytes[sizeof(T)];
        std::memcpy(bytes, &value, sizeof(T));
        text_.append(bytes, sizeof(T));
        return *this;
    }
    template <class T>
    Bytes& add_all(std::initializer_list<T> values) {
        for (const T value : values) add(value);
        return *this;
    }
    Bytes& text(const std::string& text) {
        text_ += text;
        return *this;
    }
    /// Overwrites bytes that are there.
    template <class T>
    Bytes& set(size_t at, T value) {
        std::memcpy(text_.data() + at, &value, sizeof(T));
        return *this;
    }

    const std::string& str() const { return text_; }
    size_t size() const { return text_.size(); }

  private:
    std::string text_;
};

/// What readers take; the text has to live as long.
inline std::span<const std::byte> as_span(const std::string& text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}
