# The tables of the split sum and of linearly transformed cosines are computed when the library is built and embedded.
foreach(name IN ITEMS dfg ltc)
  add_executable(generate_${name} src/easypbr/gpu/tools/generate_${name}.cpp)
  target_link_libraries(generate_${name} PRIVATE Eigen3::Eigen)
  set(table ${PROJECT_BINARY_DIR}/generated/easypbr_${name}.inc)
  add_custom_command(OUTPUT ${table} COMMAND generate_${name} ${table} DEPENDS generate_${name}
                     COMMENT "Computing the table ${name}" VERBATIM)
  target_sources(easypbr_gpu PRIVATE ${table})
endforeach()
