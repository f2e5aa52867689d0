# Flags that make errors of memory end in a stop instead of in foreign code. What the compiler does not know is left
# out; sanitizers check the same and more. tests/package/test_hardening.py reads them from what was built.
include(CheckCXXCompilerFlag)
include(CheckPIESupported)
check_pie_supported()

add_library(easypbr_hardening INTERFACE)
if(EASYPBR_HARDENING AND NOT EASYPBR_SANITIZE)
  foreach(flag -fstack-protector-strong -fstack-clash-protection -fcf-protection=full)
    string(MAKE_C_IDENTIFIER "EASYPBR_HAS${flag}" known)
    check_cxx_compiler_flag(${flag} ${known})
    if(${known})
      target_compile_options(easypbr_hardening INTERFACE ${flag})
    endif()
  endforeach()
  # It needs an optimised build. Distributions define it too, at other levels.
  target_compile_options(easypbr_hardening INTERFACE
                         $<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE> $<$<NOT:$<CONFIG:Debug>>:-D_FORTIFY_SOURCE=2>)
  target_link_options(easypbr_hardening INTERFACE -Wl,-z,relro -Wl,-z,now -Wl,-z,noexecstack)
endif()
