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

# The page of the browser view is embedded the same way, from the files that web/ was built to.
function(embed_page target folder)
  set(output ${PROJECT_BINARY_DIR}/generated/easypbr_page.inc)
  file(GLOB files CONFIGURE_DEPENDS ${folder}/*.html ${folder}/*.js ${folder}/*.css ${folder}/*.svg)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} "-DSHADERS=${files}" -P ${PROJECT_SOURCE_DIR}/cmake/embed_script.cmake
    DEPENDS ${files} ${PROJECT_SOURCE_DIR}/cmake/embed_script.cmake
    COMMENT "Embedding the page" VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
