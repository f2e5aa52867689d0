# All from the distribution's packages; CMake fetches nothing.
find_package(PkgConfig REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(TBB REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(meshoptimizer REQUIRED)
find_package(nanoflann REQUIRED)
pkg_check_modules(EPOXY REQUIRED IMPORTED_TARGET epoxy)
pkg_check_modules(SPNG REQUIRED IMPORTED_TARGET spng)
pkg_check_modules(TURBOJPEG REQUIRED IMPORTED_TARGET libturbojpeg)
find_package(tinyexr REQUIRED)
find_package(ZLIB REQUIRED)
find_package(yaml-cpp REQUIRED)
find_path(STB_FOLDER stb/stb_truetype.h REQUIRED)
find_file(EASYPBR_FONT DejaVuSans.ttf PATHS /usr/share/fonts PATH_SUFFIXES truetype/dejavu dejavu dejavu-sans-fonts
          REQUIRED)

add_library(easypbr_dependencies INTERFACE)
target_link_libraries(easypbr_dependencies INTERFACE Eigen3::Eigen fmt::fmt TBB::tbb nlohmann_json::nlohmann_json
  meshoptimizer::meshoptimizer nanoflann::nanoflann PkgConfig::EPOXY PkgConfig::SPNG PkgConfig::TURBOJPEG tinyexr::tinyexr ZLIB::ZLIB yaml-cpp ${CMAKE_DL_LIBS})
