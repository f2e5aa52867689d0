// Gives the readers a decompressor of LAZ: easypbr.laz, which asks lazrs.
#include "easypbr/io/mesh/las/laz.h"
#include "easypbr/python/bindings.h"

namespace easypbr::python {
namespace {

std::string decompress(std::string_view laszip, std::string_view points, size_t place, size_t size) {
    const nb::gil_scoped_acquire gil;
    try {
        const nb::object result =
            nb::module_::import_("easypbr.laz")
                .attr("decompress")(nb::bytes(laszip.data(), laszip.size()),
                                    nb::bytes(points.data(), points.size()), place, size);
        const nb::bytes bytes = nb::cast<nb::bytes>(result);
        return {bytes.c_str(), bytes.size()};
    } catch (const nb::python_error& error) {
        throw_as_own(error);
    }
}

}  // namespace

void bind_laz() {
    io::set_laz_decompressor(decompress);
}

}  // namespace easypbr::python
