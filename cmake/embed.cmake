# Texts are embedded: generated/NAME.inc lists { "file", R"(text)" } for each file that the patterns name.
function(embed_texts target name)
  set(output ${PROJECT_BINARY_DIR}/generated/${name}.inc)
  file(GLOB texts CONFIGURE_DEPENDS ${ARGN})
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} "-DTEXTS=${texts}" -P ${PROJECT_SOURCE_DIR}/cmake/embed_script.cmake
    DEPENDS ${texts} ${PROJECT_SOURCE_DIR}/cmake/embed_script.cmake
    COMMENT "Embedding ${name}" VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()

# Shaders, so that nothing depends on the source tree at run time.
function(embed_shaders target folder)
  embed_texts(${target} easypbr_shaders ${folder}/*.glsl ${folder}/*.vert ${folder}/*.frag ${folder}/*.comp)
endfunction()

# The files that web/ was built to: those that a server answers with, and those that are written or handed on.
function(embed_page target folder)
  embed_texts(${target} easypbr_page ${folder}/*.html ${folder}/*.js ${folder}/*.css ${folder}/*.svg)
  embed_texts(${target} easypbr_offline ${folder}/offline/*.html ${folder}/offline/*.js)
endfunction()
