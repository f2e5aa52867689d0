# Optional parts that are loaded at run time, so that the library does not depend on what they need.
function(easypbr_add_module name folder)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/easypbr/io/${folder}/*.cpp)
  add_library(easypbr_${name} MODULE ${sources})
  target_link_libraries(easypbr_${name} PRIVATE easypbr easypbr_options easypbr_dependencies ${ARGN})
  # Beside libeasypbr.so, in the build tree and where both are installed.
  set_target_properties(easypbr_${name} PROPERTIES INSTALL_RPATH "$ORIGIN" BUILD_RPATH_USE_ORIGIN ON
                                                   LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
endfunction()

find_package(assimp QUIET)
if(assimp_FOUND)
  # A program, started beside libeasypbr.so for each file: a file that makes assimp crash or loop ends it alone. It
  # has no sanitizers, whose address space is beyond every limit that it sets itself.
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/easypbr/io/mesh/assimp/reader/*.cpp)
  add_executable(easypbr_read_assimp ${sources})
  target_link_libraries(easypbr_read_assimp PRIVATE Eigen3::Eigen assimp::assimp easypbr_hardening)
  target_include_directories(easypbr_read_assimp PRIVATE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
  target_compile_definitions(easypbr_read_assimp PRIVATE ${EASYPBR_LAYOUT_DEFINITIONS})
  target_compile_options(easypbr_read_assimp PRIVATE -Wall -Wextra -Wpedantic $<$<BOOL:${EASYPBR_WERROR}>:-Werror>)
else()
  message(STATUS "assimp not found: FBX, DAE, 3DS and the like are not read (Debian: libassimp-dev)")
endif()

# Videos.
pkg_check_modules(FFMPEG QUIET IMPORTED_TARGET libavcodec libavformat libavutil libswscale)
if(FFMPEG_FOUND)
  easypbr_add_module(ffmpeg video/ffmpeg PkgConfig::FFMPEG)
else()
  message(STATUS "FFmpeg not found: videos are not written "
                 "(Debian: libavcodec-dev libavformat-dev libavutil-dev libswscale-dev)")
endif()

# Compressed triangles of glTF.
find_package(draco QUIET CONFIG)
if(draco_FOUND)
  easypbr_add_module(draco mesh/gltf/draco draco::draco)
else()
  message(STATUS "Draco not found: glTF files with KHR_draco_mesh_compression are not read (Debian: libdraco-dev)")
endif()
