#include "easypbr/io/mesh/gltf/gltf_document.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "easypbr/core/ascii.h"
#include "easypbr/core/error.h"
#include "easypbr/io/mesh/gltf/gltf_meshopt.h"
#include "easypbr/io/source/base64.h"
#include "easypbr/io/source/json_text.h"

namespace easypbr::io {
namespace {

/// Larger sizes and counts stand for no file there is; below it sums and products of two stay within 64 bits.
constexpr double largest_integer = 1099511627776.0;  // 2^40

constexpr uint32_t magic_glb = 0x46546c67, chunk_json = 0x4e4f534a, chunk_binary = 0x004e4942;

uint32_t word_at(std::span<const std::byte> bytes, size_t at) {
    uint32_t value;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
}

int hex_digit(char c) {
    if (ascii::is_digit(c)) return c - '0';
    const char lower = ascii::to_lower(c);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

std::string percent_decoded(std::string_view text) {
    std::string out;
    for (size_t i = 0; i < text.size(); ++i) {
        const bool coded = text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 &&
                           hex_digit(text[i + 2]) >= 0;
        out += coded ? char(hex_digit(text[i + 1]) * 16 + hex_digit(text[i + 2])) : text[i];
        if (coded) i += 2;
    }
    return out;
}

bool has_scheme(std::string_view uri) {
    const size_t colon = uri.find(':');
    return colon != std::string_view::npos &&
           uri.substr(0, colon).find_first_of("/?#") == std::string_view::npos;
}

}  // namespace

const Json* member(const Json& object, const char* key) {
    const auto found = object.find(key);
    return found == object.end() ? nullptr : &*found;
}

const Json* extension(const Json& object, const char* name) {
    const Json* extensions = member(object, "extensions");
    return extensions ? member(*extensions, name) : nullptr;
}

GltfDocument::GltfDocument(std::span<const std::byte> bytes, std::filesystem::path path)
    : path_(std::move(path)) {
    if (bytes.empty()) fail("the file is empty");
    const std::string_view text = json_chunk(bytes);
    root_ = parse_json<Json>(text, path_.string());
    if (!root_.is_object()) fail("expected a JSON object");
    const Json* asset = member(root_, "asset");
    const std::string version = asset ? this->text(*asset, "version") : "";
    if (!version.starts_with("2.")) fail(fmt::format("expected glTF 2.x, got asset.version '{}'", version));
    buffers_.resize(count("buffers"));
}

std::string_view GltfDocument::json_chunk(std::span<const std::byte> bytes) {
    const auto text_of = [](std::span<const std::byte> part) {
        return std::string_view(reinterpret_cast<const char*>(part.data()), part.size());
    };
    if (bytes.size() < 4 || word_at(bytes, 0) != magic_glb) return text_of(bytes);
    if (bytes.size() < 20) fail("truncated GLB header");
    if (word_at(bytes, 4) != 2) fail(fmt::format("expected GLB version 2, got {}", word_at(bytes, 4)));
    const size_t length = word_at(bytes, 8);
    if (length > bytes.size() || length < 20)
        fail(fmt::format("truncated GLB: its header says {} bytes, the file has {}", length, bytes.size()));
    std::string_view json;
    for (size_t at = 12; at + 8 <= length;) {
        const size_t size = word_at(bytes, at);
        const uint32_t kind = word_at(bytes, at + 4);
        if (size > length - at - 8) fail(fmt::format("GLB chunk at byte {} is longer than the file", at));
        const auto chunk = bytes.subspan(at + 8, size);
        if (kind == chunk_json && json.empty()) json = text_of(chunk);
        if (kind == chunk_binary && binary_chunk_.empty()) binary_chunk_ = chunk;
        at += 8 + (size + 3) / 4 * 4;
    }
    if (json.empty()) fail("GLB without a JSON chunk");
    return json;
}

const Json& GltfDocument::item(const char* array, size_t index) const {
    const size_t items = count(array);
    if (index >= items) fail(fmt::format("{}[{}] does not exist: there are {}", array, index, items));
    const Json& item = root_.at(array)[index];
    if (!item.is_object()) fail(fmt::format("{}[{}] must be an object", array, index));
    return item;
}

size_t GltfDocument::count(const char* array) const {
    const Json* items = member(root_, array);
    if (!items) return 0;
    if (!items->is_array()) fail(fmt::format("'{}' must be an array", array));
    return items->size();
}

std::span<const std::byte> GltfDocument::buffer(size_t index) {
    const Json& json = item("buffers", index);
    Buffer& buffer = buffers_[index];
    if (!buffer.loaded) {
        const size_t length = integer(json, "byteLength");
        if (!member(json, "uri")) {
            if (index != 0 || binary_chunk_.empty()) fail(fmt::format("buffers[{}] has no data", index));
            buffer.bytes = binary_chunk_;
        } else if (auto decoded = data_of_uri(text(json, "uri"))) {
            buffer.decoded = std::move(*decoded);
            buffer.bytes = buffer.decoded;
        } else {
            buffer.file = FileBytes(path_of_uri(text(json, "uri")));
            buffer.bytes = buffer.file.bytes();
        }
        if (buffer.bytes.size() < length)
            fail(fmt::format("buffers[{}] must have {} bytes, got {}", index, length, buffer.bytes.size()));
        buffer.bytes = buffer.bytes.first(length);
        buffer.loaded = true;
    }
    return buffer.bytes;
}

const std::vector<std::byte>* GltfDocument::provided(size_t accessor) const {
    const auto found = provided_.find(accessor);
    return found == provided_.end() ? nullptr : &found->second;
}

void GltfDocument::check_files() const {
    for (const Buffer& buffer : buffers_) buffer.file.check();
}

std::span<const std::byte> GltfDocument::buffer_view(size_t index) {
    const Json& view = item("bufferViews", index);
    const Json* packed = extension(view, ext_meshopt_compression);
    if (!packed) return range_of(view, index);
    const auto [found, is_new] = unpacked_views_.try_emplace(index);
    if (is_new) found->second = unpack_meshopt(*this, view, *packed, range_of(*packed, index), index);
    return found->second;
}

std::span<const std::byte> GltfDocument::range_of(const Json& range, size_t view) {
    const auto bytes = buffer(integer(range, "buffer"));
    const size_t offset = optional_integer(range, "byteOffset").value_or(0);
    const size_t length = integer(range, "byteLength");
    if (offset > bytes.size() || length > bytes.size() - offset)
        fail(fmt::format("bufferViews[{}] ends at byte {} of a buffer of {}", view, offset + length,
                         bytes.size()));
    return bytes.subspan(offset, length);
}

std::optional<std::vector<std::byte>> GltfDocument::data_of_uri(std::string_view uri) const {
    if (!uri.starts_with("data:")) return std::nullopt;
    const size_t comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64"))
        fail("a data URI must be of the form 'data:...;base64,...'");
    auto decoded = base64_decoded(uri.substr(comma + 1));
    if (!decoded) fail("a data URI holds characters that are not base 64");
    return decoded;
}

std::filesystem::path GltfDocument::path_of_uri(std::string_view uri) const {
    if (has_scheme(uri))
        fail(fmt::format("URI '{}': only relative paths and data URIs are read", uri.substr(0, 100)));
    const std::filesystem::path path = percent_decoded(uri);
    const std::filesystem::path normal = path.lexically_normal();
    if (path.is_absolute() || *normal.begin() == ".." || path.native().find('\0') != std::string::npos)
        fail(fmt::format(
            "URI '{}' leads out of the file's folder, which is not allowed: a glTF file names files "
            "beside or below itself",
            uri.substr(0, 100)));
    return path_.parent_path() / path;
}

void GltfDocument::fail(std::string_view what) const {
    throw FormatError(fmt::format("cannot read {}: {}", path_.string(), what));
}

size_t GltfDocument::whole_number(const Json& value, const char* key) const {
    const double number = value.is_number() ? value.get<double>() : -1;
    if (!(number >= 0 && number <= largest_integer) || std::floor(number) != number)
        fail(fmt::format("'{}' must be a whole number from 0 to 2^40, got {}", key, value.type_name()));
    return size_t(number);
}

size_t GltfDocument::integer(const Json& object, const char* key) const {
    const auto value = optional_integer(object, key);
    if (!value) fail(fmt::format("'{}' is missing", key));
    return *value;
}

std::optional<size_t> GltfDocument::optional_integer(const Json& object, const char* key) const {
    const Json* value = member(object, key);
    if (!value) return std::nullopt;
    return whole_number(*value, key);
}

double GltfDocument::number(const Json& object, const char* key, double fallback) const {
    const Json* value = member(object, key);
    if (!value) return fallback;
    if (!value->is_number() || !(std::abs(value->get<double>()) < 1e30))
        fail(fmt::format("'{}' must be a finite number, got {}", key, value->type_name()));
    return value->get<double>();
}

bool GltfDocument::boolean(const Json& object, const char* key, bool fallback) const {
    const Json* value = member(object, key);
    if (!value) return fallback;
    if (!value->is_boolean())
        fail(fmt::format("'{}' must be true or false, got {}", key, value->type_name()));
    return value->get<bool>();
}

std::string GltfDocument::text(const Json& object, const char* key, const std::string& fallback) const {
    const Json* value = member(object, key);
    if (!value) return fallback;
    if (!value->is_string()) fail(fmt::format("'{}' must be a string, got {}", key, value->type_name()));
    return value->get<std::string>();
}

std::optional<std::vector<double>> GltfDocument::numbers(const Json& object, const char* key,
                                                         size_t count) const {
    const Json* value = member(object, key);
    if (!value) return std::nullopt;
    if (!value->is_array() || value->size() != count)
        fail(fmt::format("'{}' must be {} numbers", key, count));
    std::vector<double> out;
    for (const Json& entry : *value) {
        if (!entry.is_number() || !(std::abs(entry.get<double>()) < 1e30))
            fail(fmt::format("'{}' must be {} finite numbers", key, count));
        out.push_back(entry.get<double>());
    }
    return out;
}

std::vector<size_t> GltfDocument::integers(const Json& object, const char* key) const {
    std::vector<size_t> out;
    const Json* value = member(object, key);
    if (!value) return out;
    if (!value->is_array()) fail(fmt::format("'{}' must be an array, got {}", key, value->type_name()));
    for (const Json& entry : *value) out.push_back(whole_number(entry, key));
    return out;
}

}  // namespace easypbr::io
