# Wheels run on systems whose C and C++ libraries are older than those of the machine that builds them (manylinux_2_34:
# glibc 2.34, libstdc++ of GCC 11). The few functions that got a newer version since are bound to the older one, which
# these libraries still have. scripts/wheel.sh has the result checked by auditwheel.
option(EASYPBR_PORTABLE "Bind to symbol versions that manylinux_2_34 has" OFF)
add_library(easypbr_portable INTERFACE)
if(EASYPBR_PORTABLE)
  if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    message(FATAL_ERROR "EASYPBR_PORTABLE knows the symbol versions of x86-64, not those of ${CMAKE_SYSTEM_PROCESSOR}")
  endif()
  add_library(easypbr_older_symbols OBJECT ${PROJECT_SOURCE_DIR}/cmake/older_symbols.c)
  set_target_properties(easypbr_older_symbols PROPERTIES C_VISIBILITY_PRESET hidden)
  foreach(symbol IN ITEMS hypot hypotf _ZNSt18condition_variable4waitERSt11unique_lockISt5mutexE)
    target_link_options(easypbr_portable INTERFACE -Wl,--wrap=${symbol})
  endforeach()
  target_sources(easypbr_portable INTERFACE $<TARGET_OBJECTS:easypbr_older_symbols>)
endif()
