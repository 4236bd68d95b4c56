# One test program per folder of tests/; it links the room of the same name, or everything.
enable_testing()
find_package(GTest REQUIRED)
include(GoogleTest)

add_custom_target(unit_tests)  # without the program, unless a test drives it

function(evenmesh_test room)
  set(folder tests/${room})
  if(room STREQUAL "gl" AND NOT EVENMESH_GL)
    set(folder tests/gl/off)
  endif()
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cpp)
  if(NOT EVENMESH_GL)
    list(FILTER sources EXCLUDE REGEX "cli/test_(shaders|raster)")
  endif()
  if(EVENMESH_SANITIZE)  # OpenVDB takes minutes to build so, and is not ours
    list(FILTER sources EXCLUDE REGEX vdb_test)
  endif()
  if(NOT sources)
    return()
  endif()
  add_executable(test_${room} ${sources})
  target_include_directories(test_${room} PRIVATE tests)
  target_link_libraries(test_${room} PRIVATE evenmesh_flags ${ARGN} fmt::fmt GTest::gtest_main)
  target_compile_options(test_${room} PRIVATE $<$<CONFIG:Release>:-O1>)  # quickly built; what they test is not
  evenmesh_precompile(test_${room} tests)
  add_dependencies(unit_tests test_${room})
  target_compile_definitions(test_${room} PRIVATE EVENMESH_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  gtest_discover_tests(test_${room} TEST_PREFIX ${room}. DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
                       PROPERTIES TIMEOUT 300)
endfunction()

foreach(room ${EVENMESH_ROOMS})
  evenmesh_test(${room} evenmesh_${room})
endforeach()

if(TARGET test_pipeline)
  target_link_libraries(test_pipeline PRIVATE evenmesh_io)  # models are files
endif()
if(TARGET test_gl AND EVENMESH_GL)
  target_link_libraries(test_gl PRIVATE evenmesh_pipeline)  # what is evaluated there is meshed, too
endif()

if(TARGET test_io AND NOT EVENMESH_SANITIZE)
  target_link_libraries(test_io PRIVATE openvdb Imath)  # reads back what the plugin wrote
  add_dependencies(test_io evenmesh_vdb)
endif()

# The house: who includes whom, examples that compile.
evenmesh_test(house)
# The program, driven from outside.
if(NOT EVENMESH_SANITIZE)
  evenmesh_test(cli nlohmann_json::nlohmann_json)
endif()
if(TARGET test_cli)
  add_dependencies(test_cli evenmesh)
  target_compile_definitions(test_cli PRIVATE EVENMESH_PROGRAM="$<TARGET_FILE:evenmesh>")
endif()

# Somebody else's project: finds the installed package, builds against it, runs.
if(NOT EVENMESH_SANITIZE)
  add_test(NAME house.consumer
           COMMAND ${CMAKE_COMMAND} -DBUILD=${CMAKE_BINARY_DIR} -DCONSUMER=${PROJECT_SOURCE_DIR}/tests/consumer
                   -DGENERATOR=${CMAKE_GENERATOR} -DCOMPILER=${CMAKE_CXX_COMPILER}
                   -P ${PROJECT_SOURCE_DIR}/tests/consumer/run.cmake)
  set_tests_properties(house.consumer PROPERTIES TIMEOUT 300)
endif()
