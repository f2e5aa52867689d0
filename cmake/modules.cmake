# Optional parts that are loaded at run time, so that the library does not depend on what they need.
find_package(assimp QUIET)
if(assimp_FOUND)
  file(GLOB assimp_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/easypbr/io/assimp/*.cpp)
  add_library(easypbr_assimp MODULE ${assimp_sources})
  target_link_libraries(easypbr_assimp PRIVATE easypbr easypbr_options easypbr_dependencies assimp::assimp)
  # Beside libeasypbr.so, in the build tree and where both are installed.
  set_target_properties(easypbr_assimp PROPERTIES INSTALL_RPATH "$ORIGIN" BUILD_RPATH_USE_ORIGIN ON)
  set_target_properties(easypbr_assimp PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
else()
  message(STATUS "assimp not found: FBX, DAE, 3DS and the like are not read (Debian: libassimp-dev)")
endif()

# Videos.
pkg_check_modules(FFMPEG QUIET IMPORTED_TARGET libavcodec libavformat libavutil libswscale)
if(FFMPEG_FOUND)
  file(GLOB ffmpeg_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/easypbr/io/ffmpeg/*.cpp)
  add_library(easypbr_ffmpeg MODULE ${ffmpeg_sources})
  target_link_libraries(easypbr_ffmpeg PRIVATE easypbr easypbr_options easypbr_dependencies PkgConfig::FFMPEG)
  set_target_properties(easypbr_ffmpeg PROPERTIES INSTALL_RPATH "$ORIGIN" BUILD_RPATH_USE_ORIGIN ON)
  set_target_properties(easypbr_ffmpeg PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
else()
  message(STATUS "FFmpeg not found: videos are not written "
                 "(Debian: libavcodec-dev libavformat-dev libavutil-dev libswscale-dev)")
endif()
