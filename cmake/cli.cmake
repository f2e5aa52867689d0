# The command line: a library, so that other programs can run it too, and the executable build/easypbr.
find_package(CLI11 REQUIRED)

file(GLOB cli_sources CONFIGURE_DEPENDS src/easypbr/cli/*.cpp)
list(REMOVE_ITEM cli_sources ${PROJECT_SOURCE_DIR}/src/easypbr/cli/main.cpp)
add_library(easypbr_cli STATIC ${cli_sources})
target_compile_definitions(easypbr_cli PRIVATE EASYPBR_VERSION="${PROJECT_VERSION}")
target_link_libraries(easypbr_cli PUBLIC easypbr PRIVATE easypbr_options easypbr_dependencies CLI11::CLI11)
target_precompile_headers(easypbr_cli PRIVATE <functional> <map> <string> <vector> <Eigen/Core> <Eigen/Geometry>
                          <fmt/format.h> <CLI/CLI.hpp>)

add_executable(easypbr_program src/easypbr/cli/main.cpp)
target_link_libraries(easypbr_program PRIVATE easypbr_cli easypbr_options)
set_target_properties(easypbr_program PROPERTIES OUTPUT_NAME easypbr BUILD_WITH_INSTALL_RPATH ON
                      INSTALL_RPATH "$ORIGIN:$ORIGIN/../lib:$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
