# The Python package, complete in the build folder: python/easypbr holds the module, its stub and links to the sources.
if(NOT DEFINED Python_EXECUTABLE AND EXISTS ${PROJECT_SOURCE_DIR}/.venv/bin/python)
  set(Python_EXECUTABLE ${PROJECT_SOURCE_DIR}/.venv/bin/python)
endif()
# scikit-build-core names the component of the stable ABI where the interpreter is new enough for it.
find_package(Python 3.10 REQUIRED COMPONENTS Interpreter Development.Module ${SKBUILD_SABI_COMPONENT})
execute_process(COMMAND ${Python_EXECUTABLE} -m nanobind --cmake_dir OUTPUT_STRIP_TRAILING_WHITESPACE
                OUTPUT_VARIABLE nanobind_ROOT RESULT_VARIABLE nanobind_missing ERROR_QUIET)
if(nanobind_missing)
  message(FATAL_ERROR "${Python_EXECUTABLE} has no nanobind: install it from PyPI (make build does), "
                      "or configure with -DEASYPBR_BUILD_PYTHON=OFF")
endif()
find_package(nanobind CONFIG REQUIRED)

set(package ${PROJECT_BINARY_DIR}/python/easypbr)
file(GLOB bindings CONFIGURE_DEPENDS src/easypbr/python/*.cpp)
# One module for Python 3.12 and later, where the stable ABI is; another for each version before.
nanobind_add_module(_easypbr NB_STATIC STABLE_ABI NB_SUPPRESS_WARNINGS NOMINSIZE ${bindings})
target_link_libraries(_easypbr PRIVATE easypbr easypbr_options easypbr_dependencies)
target_compile_definitions(_easypbr PRIVATE EASYPBR_VERSION="${PROJECT_VERSION}")
if(TARGET easypbr_cli)
  target_link_libraries(_easypbr PRIVATE easypbr_cli)
  target_compile_definitions(_easypbr PRIVATE EASYPBR_HAS_CLI)
endif()
set_target_properties(_easypbr PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${package} INSTALL_RPATH "$ORIGIN")

# The sources are linked, so that an edit needs no build.
file(GLOB package_sources CONFIGURE_DEPENDS python/easypbr/*.py python/easypbr/py.typed)
file(MAKE_DIRECTORY ${package})
foreach(source IN LISTS package_sources)
  get_filename_component(name ${source} NAME)
  file(CREATE_LINK ${source} ${package}/${name} SYMBOLIC)
endforeach()

# What coding assistants read: tasks and the calls for them.
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/docs/llms.txt ${package}/llms.txt SYMBOLIC)
foreach(folder dataset conversions compat)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/python/easypbr/${folder} ${package}/${folder} SYMBOLIC)
endforeach()

set(raw_stub ${PROJECT_BINARY_DIR}/stubs/_easypbr.pyi)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/stubs)
nanobind_add_stub(easypbr_stub INCLUDE_PRIVATE MODULE easypbr._easypbr OUTPUT ${raw_stub}
                  PYTHON_PATH ${PROJECT_BINARY_DIR}/python DEPENDS _easypbr)
add_custom_command(OUTPUT ${package}/_easypbr.pyi
                   COMMAND ${Python_EXECUTABLE} ${PROJECT_SOURCE_DIR}/scripts/complete_stub.py ${raw_stub} ${package}/_easypbr.pyi
                   DEPENDS easypbr_stub ${raw_stub} ${PROJECT_SOURCE_DIR}/scripts/complete_stub.py
                   COMMENT "Completing the types of the module's stub" VERBATIM)
add_custom_command(OUTPUT ${package}/settings.pyi
                   COMMAND ${Python_EXECUTABLE} ${PROJECT_SOURCE_DIR}/scripts/write_settings_stub.py
                           ${PROJECT_BINARY_DIR}/python
                   DEPENDS _easypbr ${PROJECT_SOURCE_DIR}/scripts/write_settings_stub.py
                   COMMENT "Writing the stub of the settings" VERBATIM)
# All that the package needs: what a wheel is built from.
add_custom_target(python_package ALL DEPENDS ${package}/_easypbr.pyi ${package}/settings.pyi)
if(TARGET easypbr_read_assimp)
  add_dependencies(python_package easypbr_read_assimp)
endif()
if(TARGET easypbr_draco)
  add_dependencies(python_package easypbr_draco)
endif()
if(TARGET easypbr_ffmpeg)
  add_dependencies(python_package easypbr_ffmpeg)
endif()

if(SKBUILD)
  # A wheel holds no symbolic links, so the library takes the one name that the module asks for.
  set_target_properties(easypbr PROPERTIES VERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
                                           INSTALL_RPATH "$ORIGIN")
  install(TARGETS _easypbr LIBRARY DESTINATION easypbr COMPONENT python)
  install(TARGETS easypbr LIBRARY DESTINATION easypbr COMPONENT python NAMELINK_SKIP)
  if(TARGET easypbr_read_assimp)
    install(TARGETS easypbr_read_assimp RUNTIME DESTINATION easypbr COMPONENT python)
  endif()
  if(TARGET easypbr_draco)
    install(TARGETS easypbr_draco LIBRARY DESTINATION easypbr COMPONENT python)
  endif()
  if(TARGET easypbr_ffmpeg)
    install(TARGETS easypbr_ffmpeg LIBRARY DESTINATION easypbr COMPONENT python)
  endif()
  install(FILES ${package}/_easypbr.pyi ${package}/settings.pyi docs/llms.txt DESTINATION easypbr COMPONENT python)
  if(EASYPBR_PORTABLE)
    # Others' libraries travel in the wheel, so their licences do too.
    set(licenses ${PROJECT_BINARY_DIR}/licenses)
    add_custom_target(easypbr_licenses COMMAND ${Python_EXECUTABLE} ${PROJECT_SOURCE_DIR}/scripts/write_licenses.py ${licenses}
                      COMMAND ${Python_EXECUTABLE} ${PROJECT_SOURCE_DIR}/scripts/write_licenses.py --sbom
                              ${PROJECT_BINARY_DIR}/sboms/easypbr.spdx.json
                      COMMENT "Collecting licences" VERBATIM)
    add_dependencies(python_package easypbr_licenses)
    install(DIRECTORY ${licenses}/ DESTINATION ${SKBUILD_METADATA_DIR}/licenses/bundled COMPONENT python)
    # Where PEP 770 puts it.
    install(FILES ${PROJECT_BINARY_DIR}/sboms/easypbr.spdx.json DESTINATION ${SKBUILD_METADATA_DIR}/sboms COMPONENT python)
  endif()
else()
  # Where Debian's Python looks, below the prefix.
  set(installed lib/python3/dist-packages/easypbr)
  set_target_properties(_easypbr PROPERTIES INSTALL_RPATH "$ORIGIN/../../../../${CMAKE_INSTALL_LIBDIR}")
  install(TARGETS _easypbr LIBRARY DESTINATION ${installed} COMPONENT python)
  install(FILES ${package}/_easypbr.pyi ${package}/settings.pyi docs/llms.txt DESTINATION ${installed} COMPONENT python)
  install(DIRECTORY python/easypbr/ DESTINATION ${installed} COMPONENT python
          PATTERN __pycache__ EXCLUDE)
endif()
