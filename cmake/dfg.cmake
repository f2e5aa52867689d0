# The table of the split sum is integrated when the library is built and embedded.
add_executable(generate_dfg src/easypbr/gpu/tools/generate_dfg.cpp)
target_link_libraries(generate_dfg PRIVATE Eigen3::Eigen)
set(dfg_table ${PROJECT_BINARY_DIR}/generated/easypbr_dfg.inc)
add_custom_command(OUTPUT ${dfg_table} COMMAND generate_dfg ${dfg_table} DEPENDS generate_dfg
                   COMMENT "Integrating the DFG table" VERBATIM)
target_sources(easypbr_gpu PRIVATE ${dfg_table})
