# Native shaders: the text of shaders/ as C++, compiled for each instruction set into a namespace of its own.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
set(native_shaders lighting_surface lighting_surface_extended background_environment display_output
                   accumulate_sample antialias_fxaa occlusion_select occlusion_horizon occlusion_hemisphere occlusion_blur occlusion_magnify
                   lighting_catcher ground_finish occlusion_normals display_surface exact_surface
                   bloom_blocks bloom_gather bloom_resample focus_halve focus_gather focus_compose
                   outline_edges outline_lines denoise_estimate denoise_smooth transparency_layer transparency_behind
                   downsample_picture eye_dome_layers shadow_share)
set(native_surface_shaders mesh_resolve mesh_extended shadow_depth)
set(native_stream_shaders path_lamps path_scatter path_lamps_extended path_scatter_extended display_color)
set(native_line_shaders overlay_lines)
set(native_folder ${PROJECT_BINARY_DIR}/generated/native)
set(native_march_v2 x86-64-v2)
set(native_march_avx2 x86-64-v3)
set(native_march_avx512 x86-64-v4)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(native_instruction_sets ${EASYPBR_INSTRUCTION_SETS})
else()
  set(native_instruction_sets base)
endif()
list(JOIN native_shaders ") X(" native_names)
list(JOIN native_instruction_sets ") X(" native_set_names)
list(JOIN native_stream_shaders ") X(" native_stream_names)
file(CONFIGURE OUTPUT ${native_folder}/shader_list.h
     CONTENT "#define EASYPBR_SHADERS(X) X(${native_names})\n#define EASYPBR_STREAMS(X) X(${native_stream_names})\n")
file(CONFIGURE OUTPUT ${native_folder}/instruction_sets.h
     CONTENT "#define EASYPBR_INSTRUCTION_SETS(X) X(${native_set_names})\n")
# Inlined wherever they are called, these would take as long to compile as all else.
set(native_apart mesh_extended.texel_of lighting_surface_extended.prefiltered lighting_surface_extended.area_form
                 lighting_surface_extended.with_ground lighting_surface_extended.through_surface)
foreach(shader IN ITEMS lighting_surface_extended path_lamps_extended path_scatter_extended)
  list(APPEND native_apart ${shader}.F_film ${shader}.charlie_lambda)
endforeach()
foreach(shader IN ITEMS lighting_surface lighting_surface_extended lighting_catcher)
  list(APPEND native_apart ${shader}.tint_part)
endforeach()
list(TRANSFORM native_apart PREPEND "--apart=")
list(TRANSFORM native_stream_shaders PREPEND "--stream=" OUTPUT_VARIABLE native_stream_options)
file(GLOB shader_texts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/shaders/*.glsl ${PROJECT_SOURCE_DIR}/shaders/*.frag)
add_custom_command(
  OUTPUT ${native_folder}/shader_uniforms.h ${native_folder}/shaders.h ${native_folder}/shader_streams.h
  COMMAND Python3::Interpreter ${PROJECT_SOURCE_DIR}/scripts/native_shaders.py ${PROJECT_SOURCE_DIR}/shaders
          ${native_folder} --define DFG_SIZE=64 --define LIGHTS_PER_BLOCK=64 --define SHADOWS --define UV_TRANSFORMS=19
          --define NATIVE --define BEHIND ${native_apart} ${native_shaders} ${native_surface_shaders}
          ${native_line_shaders} ${native_stream_options}
  DEPENDS ${shader_texts} ${PROJECT_SOURCE_DIR}/scripts/native_shaders.py
  COMMENT "Translating shaders" VERBATIM)
add_custom_target(easypbr_native_texts DEPENDS ${native_folder}/shader_uniforms.h ${native_folder}/shaders.h
                                               ${native_folder}/shader_streams.h)
foreach(room IN ITEMS native gpu render app gui dataset remote drawing viewer)
  add_dependencies(easypbr_${room} easypbr_native_texts)
endforeach()
target_sources(easypbr_native PRIVATE ${native_folder}/shader_uniforms.h)

set(native_optimization -O2)
if(EASYPBR_SANITIZE)
  set(native_optimization -O1)
endif()
# GCC takes half an hour to guard the stack of these functions, and two minutes for all else.
if(EASYPBR_SANITIZE MATCHES "address" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  list(APPEND native_optimization -fno-sanitize-address-use-after-scope "SHELL:--param asan-stack=0")
endif()

# No contraction: all instruction sets compute the same bits.
function(easypbr_add_instruction_set name)
  add_library(easypbr_native_${name} OBJECT ${PROJECT_SOURCE_DIR}/src/easypbr/native/simd/kernels.cpp)
  target_link_libraries(easypbr_native_${name} PRIVATE easypbr_options)
  target_compile_definitions(easypbr_native_${name} PRIVATE EASYPBR_ISA=${name})
  target_compile_options(easypbr_native_${name} PRIVATE ${native_optimization} -ffp-contract=off -fno-math-errno -fno-trapping-math
                         # Registers of whole functions at once: a fifth less to compile, and smaller code.
                         $<$<CXX_COMPILER_ID:GNU>:-fira-region=one>
                         # Shader functions ignore arguments. GCC 12 takes its own intrinsics for uninitialised.
                         -Wno-unused-parameter -Wno-psabi -Wno-maybe-uninitialized -Wno-uninitialized ${ARGN})
  add_dependencies(easypbr_native_${name} easypbr_native_texts)
  set(room_objects ${room_objects} $<TARGET_OBJECTS:easypbr_native_${name}> PARENT_SCOPE)
endfunction()

foreach(instruction_set IN LISTS native_instruction_sets)
  if(instruction_set STREQUAL "base")
    easypbr_add_instruction_set(base)
  else()
    easypbr_add_instruction_set(${instruction_set} -march=${native_march_${instruction_set}})
  endif()
endforeach()
