# All from the distribution's packages; CMake fetches nothing.
find_package(PkgConfig REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
# The layout of what has vectors of Eigen, a part of the library's ABI, would depend on -march and EIGEN_DONT_VECTORIZE.
# This is Eigen's own value for the instruction sets without AVX; include/easypbr/core/math.h refuses others.
set(EASYPBR_LAYOUT_DEFINITIONS EIGEN_MAX_STATIC_ALIGN_BYTES=16)
# So does that of containers on libstdc++'s debug mode: where the flags ask for it, programs have it too. Where flags ask
# for it in some configurations alone, by generator expressions or as those of a type, it is permitted in this build.
# include/easypbr/core/error.h refuses it elsewhere.
get_directory_property(directory_definitions COMPILE_DEFINITIONS)
get_directory_property(directory_options COMPILE_OPTIONS)
set(possible_flags "${CMAKE_CXX_FLAGS} ${directory_definitions} ${directory_options}")
string(GENEX_STRIP "${possible_flags}" certain_flags)
get_property(is_multi_config GLOBAL PROPERTY GENERATOR_IS_MULTI_CONFIG)
if(is_multi_config)
  foreach(type IN LISTS CMAKE_CONFIGURATION_TYPES)
    string(TOUPPER "CMAKE_CXX_FLAGS_${type}" flags_of_type)
    string(APPEND possible_flags " ${${flags_of_type}}")
  endforeach()
else()
  string(TOUPPER "CMAKE_CXX_FLAGS_${CMAKE_BUILD_TYPE}" flags_of_type)
  string(APPEND certain_flags " ${${flags_of_type}}")
endif()
set(EASYPBR_PERMITTED_DEFINITIONS)
if(certain_flags MATCHES "_GLIBCXX_DEBUG([ ;=]|$)")
  list(APPEND EASYPBR_LAYOUT_DEFINITIONS _GLIBCXX_DEBUG EASYPBR_GLIBCXX_DEBUG)
elseif(possible_flags MATCHES "_GLIBCXX_DEBUG([^_]|$)")
  set(EASYPBR_PERMITTED_DEFINITIONS EASYPBR_GLIBCXX_DEBUG)
  add_compile_definitions(${EASYPBR_PERMITTED_DEFINITIONS})
endif()
find_package(fmt REQUIRED)
find_package(TBB REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(meshoptimizer REQUIRED)
find_package(nanoflann REQUIRED)
# Of both, which have targets of one name, the newer.
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3 REQUIRED)
endif()
pkg_check_modules(EPOXY REQUIRED IMPORTED_TARGET epoxy)
pkg_check_modules(SPNG REQUIRED IMPORTED_TARGET spng)
pkg_check_modules(TURBOJPEG REQUIRED IMPORTED_TARGET libturbojpeg)
pkg_check_modules(WEBP REQUIRED IMPORTED_TARGET libwebp)
find_package(tinyexr REQUIRED)
find_package(ZLIB REQUIRED)
find_package(yaml-cpp REQUIRED)
# Headers alone; src/easypbr/remote/connection.h and network.cpp include them.
find_path(BOOST_FOLDER boost/beast.hpp REQUIRED)
find_path(STB_FOLDER stb/stb_truetype.h REQUIRED)
# The window's library is loaded when the first window is opened: only its header is needed here.
find_path(GLFW_FOLDER GLFW/glfw3.h REQUIRED)
find_path(XCB_FOLDER xcb/xcb.h REQUIRED)
find_path(IMGUI_FOLDER imgui.h PATH_SUFFIXES imgui REQUIRED)
# As archives, so that nothing of them has to be installed where the library runs.
find_library(IMGUI_LIBRARY libimgui.a REQUIRED)
find_library(STB_LIBRARY libstb.a REQUIRED)
find_library(ZSTD_LIBRARY libzstd.a REQUIRED)
find_file(EASYPBR_FONT DejaVuSans.ttf PATHS /usr/share/fonts PATH_SUFFIXES truetype/dejavu dejavu dejavu-sans-fonts
          REQUIRED)

add_library(easypbr_dependencies INTERFACE)
target_link_libraries(easypbr_dependencies INTERFACE Eigen3::Eigen fmt::fmt TBB::tbb nlohmann_json::nlohmann_json
  meshoptimizer::meshoptimizer nanoflann::nanoflann embree PkgConfig::EPOXY PkgConfig::SPNG PkgConfig::TURBOJPEG PkgConfig::WEBP tinyexr::tinyexr ZLIB::ZLIB ${ZSTD_LIBRARY} yaml-cpp ${CMAKE_DL_LIBS})
target_compile_definitions(easypbr_dependencies INTERFACE ${EASYPBR_LAYOUT_DEFINITIONS})
# What the room gui alone uses.
add_library(easypbr_gui_dependencies INTERFACE)
target_link_libraries(easypbr_gui_dependencies INTERFACE ${IMGUI_LIBRARY} ${STB_LIBRARY})
target_include_directories(easypbr_gui_dependencies SYSTEM INTERFACE ${GLFW_FOLDER} ${IMGUI_FOLDER})
