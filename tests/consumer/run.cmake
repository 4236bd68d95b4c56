# Installs the build folder BUILD into a tree of its own, then configures, builds and runs the project CONSUMER against it.
set(prefix ${BUILD}/consumer/tree)
set(work ${BUILD}/consumer/work)
file(REMOVE_RECURSE ${BUILD}/consumer)
foreach(step
    "${CMAKE_COMMAND};--install;${BUILD};--prefix;${prefix}"
    "${CMAKE_COMMAND};-S;${CONSUMER};-B;${work};-G;${GENERATOR};-DCMAKE_CXX_COMPILER=${COMPILER};-DCMAKE_PREFIX_PATH=${prefix};-DCMAKE_BUILD_TYPE=Release"
    "${CMAKE_COMMAND};--build;${work}"
    "${work}/consumer")
  execute_process(COMMAND ${step} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "failed (${status}): ${step}\n${output}")
  endif()
endforeach()
message(STATUS "${output}")
