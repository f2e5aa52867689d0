#include "easypbr/io/mesh/gltf/gltf_meshopt.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>

#include "easypbr/core/memory_budget.h"

namespace easypbr::io {
namespace {

/// Rows of a compressed view.
struct PackedForm {
    size_t count = 0, stride = 0;
    std::string mode, filter;
};

struct PackedMode {
    const char* name;
    bool (*fits)(const PackedForm&);
    decltype(&meshopt_decodeVertexBuffer) decode;
};

bool is_packed_index(const PackedForm& form) {
    return form.stride == 2 || form.stride == 4;
}

const PackedMode packed_modes[] = {
    {"ATTRIBUTES", [](const PackedForm& form) { return form.stride % 4 == 0 && form.stride <= 256; },
     meshopt_decodeVertexBuffer},
    {"TRIANGLES", [](const PackedForm& form) { return is_packed_index(form) && form.count % 3 == 0; },
     meshopt_decodeIndexBuffer},
    {"INDICES", is_packed_index, meshopt_decodeIndexSequence},
};

struct PackedFilter {
    const char* name;
    bool (*fits)(const PackedForm&);
    void (*apply)(void* rows, size_t count, size_t stride);
};

const PackedFilter packed_filters[] = {
    {"NONE", [](const PackedForm&) { return true; }, [](void*, size_t, size_t) {}},
    {"OCTAHEDRAL", [](const PackedForm& form) { return form.stride == 4 || form.stride == 8; },
     meshopt_decodeFilterOct},
    {"QUATERNION", [](const PackedForm& form) { return form.stride == 8; }, meshopt_decodeFilterQuat},
    {"EXPONENTIAL", [](const PackedForm& form) { return form.stride % 4 == 0; }, meshopt_decodeFilterExp},
};

}  // namespace

std::vector<std::byte> unpack_meshopt(const GltfDocument& document, const Json& view, const Json& packed,
                                      std::span<const std::byte> bytes, size_t index) {
    const auto fail = [&](const std::string& what) {
        document.fail(fmt::format("bufferViews[{}], {}: {}", index, ext_meshopt_compression, what));
    };
    const PackedForm form{.count = document.integer(packed, "count"),
                          .stride = document.integer(packed, "byteStride"),
                          .mode = document.text(packed, "mode"),
                          .filter = document.text(packed, "filter", "NONE")};
    const auto mode = std::ranges::find(packed_modes, form.mode, &PackedMode::name);
    const auto filter = std::ranges::find(packed_filters, form.filter, &PackedFilter::name);
    if (mode == std::end(packed_modes)) fail(fmt::format("unknown mode '{}'", form.mode));
    if (filter == std::end(packed_filters)) fail(fmt::format("unknown filter '{}'", form.filter));
    const bool is_plain = filter == std::begin(packed_filters);
    if (form.count < 1 || form.stride < 1 || !mode->fits(form) || !filter->fits(form) ||
        (!is_plain && mode != std::begin(packed_modes)))
        fail(fmt::format("mode {} and filter {} do not go with {} rows of {} bytes", form.mode, form.filter,
                         form.count, form.stride));
    const size_t length = document.integer(view, "byteLength");
    if (length != form.count * form.stride)
        fail(fmt::format("{} rows of {} bytes do not make the view's {}", form.count, form.stride, length));
    charge_memory(length, fmt::format("bufferViews[{}]", index));
    std::vector<std::byte> out(length);
    const int result = mode->decode(out.data(), form.count, form.stride,
                                    reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    if (result != 0) fail(fmt::format("damaged data of mode {}", form.mode));
    filter->apply(out.data(), form.count, form.stride);
    return out;
}

}  // namespace easypbr::io
