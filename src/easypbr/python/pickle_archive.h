// Objects as dicts that pickle keeps, and back: exchange(archive, object), which names the members, serves
// both ways.
#pragma once

#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/handles.h"
#include "easypbr/python/text.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::python::pickled {

template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_same_v<T, std::string> ||
    std::is_same_v<T, std::filesystem::path> || std::is_same_v<T, std::array<double, 8>>;

/// Members of an object as a dict, by their names. What is none, empty or automatic is left out.
class Saved {
  public:
    /// Images and label maps that several members share are kept once.
    using Shared = std::map<const void*, nb::object>;

    explicit Saved(Shared& shared) : shared_(&shared) {}
    const nb::dict& state() const { return state_; }

    template <class T>
    void operator()(const char* name, const T& value) {
        const nb::object object = object_of(value);
        if (!object.is_none()) state_[name] = object;
    }
    template <class Enum>
    void choice(const char* name, Enum value, int /*count*/) {
        state_[name] = int(value);
    }

  private:
    template <Plain T>
    nb::object object_of(const T& value) {
        return nb::cast(value);
    }
    nb::object object_of(const std::array<double, 8>& values) {
        return nb::cast(std::vector<double>(values.begin(), values.end()));
    }
    nb::object object_of(const std::vector<uint8_t>& bytes) {
        if (bytes.empty()) return nb::none();
        return nb::bytes(bytes.data(), bytes.size());
    }
    template <class Scalar, int Rows, int Cols>
    requires(Rows > 0 && Cols > 0) nb::object object_of(const Eigen::Matrix<Scalar, Rows, Cols>& matrix) {
        return nb::cast(std::vector<double>(matrix.data(), matrix.data() + matrix.size()));
    }
    template <class Scalar, int Cols>
    nb::object object_of(const Array<Scalar, Cols>& array) {
        if (array.empty()) return nb::none();
        return view_of(array).attr("view")(nb::module_::import_("numpy").attr("ndarray"));
    }
    nb::object object_of(const std::shared_ptr<const Image>& image) {
        if (!image) return nb::none();
        return shared(image.get(), [&] { return to_numpy(image); });
    }
    nb::object object_of(const std::shared_ptr<const LabelMap>& map) {
        if (!map) return nb::none();
        return shared(map.get(), [&] { return nb::cast(LabelMapHandle{map}); });
    }
    nb::object object_of(const Style& style);
    nb::object object_of(const MeshList& children);
    template <class T>
    nb::object object_of(const std::optional<T>& value) {
        return value ? object_of(*value) : nb::none();
    }
    template <class T>
    nb::object object_of(const std::vector<T>& values) {
        nb::list list;
        for (const T& value : values) list.append(object_of(value));
        return list.size() ? nb::object(list) : nb::none();
    }
    template <class T>
    nb::object object_of(const T& value) {
        Saved members(*shared_);
        exchange(members, value);
        return members.state();
    }

    template <class Make>
    nb::object shared(const void* key, Make&& make) {
        nb::object& object = (*shared_)[key];
        if (!object.is_valid()) object = make();
        return object;
    }

    Shared* shared_;
    nb::dict state_;
};

/// The reverse. Members that the dict lacks stay as they are.
class Loaded {
  public:
    using Shared = std::map<PyObject*, std::shared_ptr<const void>>;

    Loaded(const nb::dict& state, Shared& shared) : state_(state), shared_(&shared) {}

    template <class T>
    void operator()(const char* name, T& value) {
        if (const nb::object object = take(name); object.is_valid()) load(object, value, name);
    }
    template <class Enum>
    void choice(const char* name, Enum& value, int count) {
        const nb::object object = take(name);
        if (!object.is_valid()) return;
        const int index = nb::cast<int>(object);
        if (index < 0 || index >= count)
            throw ArgumentError(fmt::format("pickle: {}: expected 0 to {}, got {}", name, count - 1, index));
        value = Enum(index);
    }
    /// Throws ArgumentError when the dict has members that were not asked for.
    void finish() const {
        if (left_.size())
            throw ArgumentError(
                fmt::format("pickle: '{}' is not known: it was written by a newer version of easypbr",
                            nb::cast<std::string>(nb::str(*left_.begin()))));
    }

  private:
    nb::object take(const char* name) {
        if (!state_.contains(name)) return {};
        left_.attr("discard")(name);
        return nb::borrow(state_[name]);
    }

    template <Plain T>
    void load(const nb::object& object, T& value, const char*) {
        value = nb::cast<T>(object);
    }
    void load(const nb::object& object, std::array<double, 8>& values, const char* name) {
        std::ranges::copy(numbers<8>(object, name), values.begin());
    }
    void load(const nb::object& object, std::vector<uint8_t>& values, const char*) {
        const auto bytes = nb::cast<nb::bytes>(object);
        const auto* const first = static_cast<const uint8_t*>(bytes.data());
        values.assign(first, first + bytes.size());
    }
    template <class Scalar, int Rows, int Cols>
    requires(Rows > 0 && Cols > 0) void load(const nb::object& object,
                                             Eigen::Matrix<Scalar, Rows, Cols>& matrix, const char* name) {
        const auto values = numbers<size_t(Rows * Cols)>(object, name);
        for (int i = 0; i < Rows * Cols; ++i) matrix.data()[i] = Scalar(values[size_t(i)]);
    }
    template <class Scalar, int Cols>
    void load(const nb::object& object, Array<Scalar, Cols>& array, const char* name) {
        const nb::object shape = object.attr("shape");
        const int given = nb::len(shape) > 1 ? nb::cast<int>(shape[1]) : 1;
        const int columns = Cols == Eigen::Dynamic ? given : Cols;
        array = to_array<Scalar, Cols>(object, {name, columns, columns});
    }
    void load(const nb::object& object, std::shared_ptr<const Image>& image, const char* name) {
        image = shared<Image>(object, [&] { return std::make_shared<const Image>(to_image(object, name)); });
    }
    void load(const nb::object& object, std::shared_ptr<const LabelMap>& map, const char*) {
        map = nb::cast<const LabelMapHandle&>(object).map;
    }
    void load(const nb::object& object, Style& style, const char* name);
    void load(const nb::object& object, MeshList& children, const char* name);
    template <class T>
    void load(const nb::object& object, std::optional<T>& value, const char* name) {
        load(object, value.emplace(), name);
    }
    template <class T>
    void load(const nb::object& object, std::vector<T>& values, const char* name) {
        values.clear();
        for (nb::handle item : object) load(nb::borrow(item), values.emplace_back(), name);
    }
    template <class T>
    void load(const nb::object& object, T& value, const char*) {
        Loaded members(nb::cast<nb::dict>(object), *shared_);
        exchange(members, value);
        members.finish();
    }

    template <size_t count>
    static std::vector<double> numbers(const nb::object& object, const char* name) {
        auto values = nb::cast<std::vector<double>>(object);
        if (values.size() != count)
            throw ArgumentError(
                fmt::format("pickle: {}: expected {} numbers, got {}", name, count, values.size()));
        return values;
    }
    template <class T, class Make>
    std::shared_ptr<const T> shared(const nb::object& object, Make&& make) {
        std::shared_ptr<const void>& kept = (*shared_)[object.ptr()];
        if (!kept) kept = make();
        return std::static_pointer_cast<const T>(kept);
    }

    nb::dict state_;
    nb::set left_{state_};
    Shared* shared_;
};

}  // namespace easypbr::python::pickled
