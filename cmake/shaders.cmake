# Embeds src/gl/shaders/*.glsl in the library: build/shaders.cpp, rewritten when one of them changes.
file(GLOB shaders CONFIGURE_DEPENDS src/gl/shaders/*.glsl)
add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/shaders.cpp
                   COMMAND ${CMAKE_COMMAND} "-DSHADERS=${shaders}" -DOUTPUT=${CMAKE_BINARY_DIR}/shaders.cpp
                           -P ${PROJECT_SOURCE_DIR}/cmake/embed_shaders.cmake
                   DEPENDS ${shaders} ${PROJECT_SOURCE_DIR}/cmake/embed_shaders.cmake
                   COMMENT "Embedding shaders" VERBATIM)
target_sources(evenmesh_gl PRIVATE ${CMAKE_BINARY_DIR}/shaders.cpp)
