# Shaders are embedded as text: generated/easypbr_shaders.inc lists { "name", R"(text)" } for each file.
function(embed_shaders target folder)
  set(output ${PROJECT_BINARY_DIR}/generated/easypbr_shaders.inc)
  file(GLOB shaders CONFIGURE_DEPENDS ${folder}/*.glsl ${folder}/*.vert ${folder}/*.frag ${folder}/*.comp)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} "-DSHADERS=${shaders}" -P ${PROJECT_SOURCE_DIR}/cmake/embed_script.cmake
    DEPENDS ${shaders} ${PROJECT_SOURCE_DIR}/cmake/embed_script.cmake
    COMMENT "Embedding shaders" VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
