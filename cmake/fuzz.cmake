# `fuzz`: the readers alone, with libFuzzer, AddressSanitizer and UndefinedBehaviorSanitizer, for clang. scripts/fuzz.sh
# builds and runs it.
file(GLOB_RECURSE sources CONFIGURE_DEPENDS src/easypbr/core/*.cpp src/easypbr/scene/*.cpp src/easypbr/io/*.cpp
     src/easypbr/gl/*.cpp)
list(FILTER sources EXCLUDE REGEX "/(reader|ffmpeg|draco)/")
# The settings have rows of effects.
file(GLOB_RECURSE rows CONFIGURE_DEPENDS src/easypbr/render/*_settings.cpp)
add_executable(fuzz ${sources} ${rows} src/easypbr/remote/messages.cpp tests/fuzz/targets.cpp tests/fuzz/fuzz.cpp)
set_source_files_properties(src/easypbr/gl/context.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
embed_shaders(fuzz ${PROJECT_SOURCE_DIR}/shaders)
embed_texts(fuzz easypbr_presets ${PROJECT_SOURCE_DIR}/src/easypbr/io/settings/presets/*.json)
target_include_directories(fuzz PRIVATE tests)
target_link_libraries(fuzz PRIVATE easypbr_options easypbr_dependencies)
# Lines that were covered are counted beside the edges that guide the fuzzer.
set(sanitizers -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=all -fprofile-instr-generate -fcoverage-mapping)
target_compile_options(fuzz PRIVATE -O1 -g -fno-omit-frame-pointer ${sanitizers})
target_link_options(fuzz PRIVATE ${sanitizers})
set_target_properties(fuzz PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 10)
