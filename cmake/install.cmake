# The public headers are installed as they are: #include <easypbr/scene/mesh.h> inside and outside.
include(CMakePackageConfigHelpers)
install(TARGETS easypbr EXPORT easypbrTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)
# Beside the library, which starts it from there.
if(TARGET easypbr_read_assimp)
  install(TARGETS easypbr_read_assimp RUNTIME DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)
endif()
if(TARGET easypbr_ffmpeg)
  install(TARGETS easypbr_ffmpeg LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)
endif()
install(TARGETS easypbr_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT library)
install(DIRECTORY include/easypbr DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT library)
install(EXPORT easypbrTargets NAMESPACE easypbr:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/easypbr COMPONENT library)
configure_package_config_file(cmake/easypbrConfig.cmake.in ${PROJECT_BINARY_DIR}/easypbrConfig.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/easypbr)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/easypbrConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/easypbrConfig.cmake ${PROJECT_BINARY_DIR}/easypbrConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/easypbr COMPONENT library)
