# The public headers are installed as they are: #include <easypbr/scene/mesh.h> inside and outside.
include(CMakePackageConfigHelpers)
# Components are packages of their own, see cmake/package.cmake: library, program, development, python.
install(TARGETS easypbr EXPORT easypbrTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library
                                                      NAMELINK_COMPONENT development)
# Beside the library, which starts it from there.
if(TARGET easypbr_read_assimp)
  install(TARGETS easypbr_read_assimp RUNTIME DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)
endif()
if(TARGET easypbr_draco)
  install(TARGETS easypbr_draco LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)
endif()
if(TARGET easypbr_ffmpeg)
  install(TARGETS easypbr_ffmpeg LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)
endif()
install(TARGETS easypbr_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
install(DIRECTORY include/easypbr DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(EXPORT easypbrTargets NAMESPACE easypbr:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/easypbr COMPONENT development)
configure_package_config_file(cmake/easypbrConfig.cmake.in ${PROJECT_BINARY_DIR}/easypbrConfig.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/easypbr)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/easypbrConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/easypbrConfig.cmake ${PROJECT_BINARY_DIR}/easypbrConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/easypbr COMPONENT development)
# For builds without CMake. The prefix is found from the place of the file, so that it may move.
file(RELATIVE_PATH EASYPBR_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
list(TRANSFORM EASYPBR_LAYOUT_DEFINITIONS PREPEND -D OUTPUT_VARIABLE layout_flags)
list(JOIN layout_flags " " layout_flags)
configure_file(cmake/easypbr.pc.in ${PROJECT_BINARY_DIR}/easypbr.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/easypbr.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

# Manual pages and completions, which the program writes from its own table of options.
set(shell_pages ${PROJECT_BINARY_DIR}/share)
add_custom_command(OUTPUT ${shell_pages}/man/easypbr.1 ${shell_pages}/easypbr ${shell_pages}/_easypbr ${shell_pages}/easypbr.fish
                   COMMAND ${CMAKE_COMMAND} -E make_directory ${shell_pages}
                   COMMAND easypbr_program man --output ${shell_pages}/man
                   COMMAND easypbr_program completion bash > ${shell_pages}/easypbr
                   COMMAND easypbr_program completion zsh > ${shell_pages}/_easypbr
                   COMMAND easypbr_program completion fish > ${shell_pages}/easypbr.fish
                   DEPENDS easypbr_program COMMENT "Writing manual pages and completions" VERBATIM)
add_custom_target(easypbr_shell_pages ALL DEPENDS ${shell_pages}/man/easypbr.1)
install(DIRECTORY ${shell_pages}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program OPTIONAL)
install(FILES ${shell_pages}/easypbr DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program
        OPTIONAL)
install(FILES ${shell_pages}/_easypbr DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT program OPTIONAL)
install(FILES ${shell_pages}/easypbr.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program
        OPTIONAL)

# For file managers: how pictures of mesh files are made, and the types of files that are not known otherwise.
install(FILES cmake/desktop/easypbr.thumbnailer DESTINATION ${CMAKE_INSTALL_DATADIR}/thumbnailers COMPONENT program)
install(FILES cmake/desktop/easypbr.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages COMPONENT program)
