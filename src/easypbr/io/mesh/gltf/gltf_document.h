// A glTF 2.0 or GLB file as JSON with its buffers; every look-up is checked.
#pragma once

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/core/file.h"

namespace easypbr::io {

using Json = nlohmann::json;

class GltfDocument {
  public:
    /// `bytes` (JSON text or GLB) are used, not copied; `path` stands in messages and its folder holds the
    /// resources.
    GltfDocument(std::span<const std::byte> bytes, std::filesystem::path path);

    const Json& root() const { return root_; }
    const std::filesystem::path& path() const { return path_; }

    /// Element `index` of the top-level array `array`. Throws FormatError when there is none or it is no
    /// object.
    const Json& item(const char* array, size_t index) const;
    size_t count(const char* array) const;

    /// The bytes of a buffer view, unpacked if it is compressed, which live as long as the document. Throws
    /// FormatError, or FileError when a file that holds them cannot be read.
    std::span<const std::byte> buffer_view(size_t index);

    /// Gives accessors without a buffer view their rows, close together, in place of all given before.
    void provide(std::map<size_t, std::vector<std::byte>> rows) { provided_ = std::move(rows); }
    /// The rows given to an accessor, or null.
    const std::vector<std::byte>* provided(size_t accessor) const;

    /// What a URI stands for: the bytes of a data URI, else nothing. Throws FormatError for a damaged one.
    std::optional<std::vector<std::byte>> data_of_uri(std::string_view uri) const;
    /// Path of the file that a relative URI names. Throws FormatError for a URI with a scheme, and for one
    /// that leads out of the document's folder.
    std::filesystem::path path_of_uri(std::string_view uri) const;

    /// To be called when all has been read. Throws FileError when a buffer's file changed meanwhile.
    void check_files() const;

    /// Throws FormatError: "cannot read PATH: WHAT".
    [[noreturn]] void fail(std::string_view what) const;

    // Members of a JSON object, checked. Each throws FormatError, with the key, for a value of another kind.
    size_t integer(const Json& object, const char* key) const;
    std::optional<size_t> optional_integer(const Json& object, const char* key) const;
    double number(const Json& object, const char* key, double fallback) const;
    bool boolean(const Json& object, const char* key, bool fallback) const;
    std::string text(const Json& object, const char* key, const std::string& fallback = {}) const;
    /// Numbers of an array, which must be `count`; nothing when there is no such member.
    std::optional<std::vector<double>> numbers(const Json& object, const char* key, size_t count) const;
    /// Whole numbers of an array; empty when there is no such member.
    std::vector<size_t> integers(const Json& object, const char* key) const;

  private:
    std::string_view json_chunk(std::span<const std::byte> bytes);
    std::span<const std::byte> buffer(size_t index);
    /// The bytes that buffer, byteOffset and byteLength name, of a buffer view or of its compressed form.
    std::span<const std::byte> range_of(const Json& range, size_t view);
    size_t whole_number(const Json& value, const char* key) const;

    struct Buffer {
        bool loaded = false;
        FileBytes file;
        std::vector<std::byte> decoded;
        std::span<const std::byte> bytes;
    };

    std::filesystem::path path_;
    Json root_;
    std::span<const std::byte> binary_chunk_;
    std::vector<Buffer> buffers_;
    std::map<size_t, std::vector<std::byte>> unpacked_views_;  ///< of compressed ones
    std::map<size_t, std::vector<std::byte>> provided_;        ///< by accessor
};

/// The member of an object, or null.
const Json* member(const Json& object, const char* key);
/// extensions.NAME of an object, or null.
const Json* extension(const Json& object, const char* name);

}  // namespace easypbr::io
