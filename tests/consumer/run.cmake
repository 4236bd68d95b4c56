# Installs the build folder BUILD into a tree of its own, then configures, builds and runs the project of this folder against
# it: a user of its own, the C++ of README.md and the examples of SOURCE.
set(prefix ${BUILD}/consumer/tree)
set(work ${BUILD}/consumer/work)
set(evenmesh ${prefix}/bin/evenmesh)
file(REMOVE_RECURSE ${BUILD}/consumer)
file(MAKE_DIRECTORY ${work})

function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${work} RESULT_VARIABLE status OUTPUT_VARIABLE output
                  ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "failed (${status}): ${ARGN}\n${output}")
  endif()
  message(STATUS "${output}")
endfunction()

# run_for(FILE COMMAND…): what it leaves is a mesh.
function(run_for file)
  run(${ARGN})
  run(${evenmesh} info ${file})
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${work} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER}
    -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_BUILD_TYPE=Release -DEXAMPLES=${SOURCE}/examples -DREADME=${SOURCE}/README.md)
run(${CMAKE_COMMAND} --build ${work})
run(${work}/main)

run_for(scan.stl ${evenmesh} mesh gallery:tangle -n 3000 --iterations 0 --start random -o scan.stl)
run_for(even.ply ${work}/readme)
run_for(small.off ${work}/remesh_file scan.stl small.off 1000)
run_for(torus.ply ${work}/mesh_expression)
run_for(bead.ply ${work}/mesh_indicator)

# Every example was run.
file(GLOB examples RELATIVE ${SOURCE}/examples ${SOURCE}/examples/*.cpp)
if(NOT examples STREQUAL "mesh_expression.cpp;mesh_indicator.cpp;remesh_file.cpp")
  message(FATAL_ERROR "run these examples here, too: ${examples}")
endif()
