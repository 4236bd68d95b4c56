# One test program per folder of tests/; it links the module of the same name, or everything.
enable_testing()
include(GoogleTest)

add_custom_target(unit_tests)  # without the program, unless a test drives it

function(evenmesh_test module)
  file(GLOB sources CONFIGURE_DEPENDS tests/${module}/*.cpp)
  if(NOT EVENMESH_GL)  # shaders and --raster need it; tests/without_gl sees that they are refused
    list(FILTER sources EXCLUDE REGEX "cli/test_(shaders|raster)")
  endif()
  if(EVENMESH_SANITIZE OR NOT EVENMESH_OPENVDB)  # it takes minutes to build with sanitizers, and is not ours
    list(FILTER sources EXCLUDE REGEX "io/vdb_test|cli/test_volumes")
  endif()
  if(NOT sources)
    return()
  endif()
  add_executable(test_${module} ${sources})
  target_include_directories(test_${module} PRIVATE tests)
  target_link_libraries(test_${module} PRIVATE evenmesh_flags ${ARGN} fmt::fmt GTest::gtest_main)
  target_compile_options(test_${module} PRIVATE $<$<CONFIG:Release>:-O1>)  # quickly built; what they test is not
  evenmesh_precompile(test_${module} tests)
  add_dependencies(unit_tests test_${module})
  target_compile_definitions(test_${module} PRIVATE EVENMESH_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  gtest_discover_tests(test_${module} TEST_PREFIX ${module}. DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
                       PROPERTIES TIMEOUT 300)
endfunction()

foreach(module ${EVENMESH_MODULES})
  if(EVENMESH_GL OR NOT module STREQUAL "gl")  # else tests/without_gl
    evenmesh_test(${module} evenmesh_${module})
  endif()
endforeach()

foreach(module grid features cvt connect topology refine)  # their tests sample surfaces and connect what they found
  target_link_libraries(test_${module} PRIVATE evenmesh_features evenmesh_band evenmesh_connect)
endforeach()
if(TARGET test_pipeline)
  target_link_libraries(test_pipeline PRIVATE evenmesh_io)  # models are files
endif()
if(TARGET test_gl)
  target_link_libraries(test_gl PRIVATE evenmesh_pipeline)  # what is evaluated there is meshed, too
  # Where there is no driver, these tests fail; none is skipped.
  add_test(NAME gl.AMissingDriverIsAFailure
           COMMAND test_gl --gtest_filter=Context.IsThereAndHasAName:*/SampleForms.NothingInsideIsSaid/*)
  set_tests_properties(gl.AMissingDriverIsAFailure PROPERTIES
                       ENVIRONMENT "__EGL_VENDOR_LIBRARY_DIRS=/nonexistent;LIBGL_DRIVERS_PATH=/nonexistent"
                       PASS_REGULAR_EXPRESSION "3 FAILED TESTS")
endif()

if(TARGET test_io AND TARGET evenmesh_vdb AND NOT EVENMESH_SANITIZE)
  target_link_libraries(test_io PRIVATE openvdb Imath)  # reads back what the plugin wrote
  add_dependencies(test_io evenmesh_vdb)
endif()

# Who includes whom.
evenmesh_test(layering)
# The program, driven from outside.
if(NOT EVENMESH_SANITIZE)
  evenmesh_test(cli nlohmann_json::nlohmann_json)
endif()
if(TARGET test_cli)
  add_dependencies(test_cli evenmesh)
  target_compile_definitions(test_cli PRIVATE EVENMESH_PROGRAM="$<TARGET_FILE:evenmesh>")
endif()

# What is said without OpenGL. Builds that have it make the program once more, with what stands for the module gl: no
# second build is needed.
if(NOT EVENMESH_SANITIZE)
  set(stand_in evenmesh_gl)
  set(program evenmesh)
  if(EVENMESH_GL)
    set(stand_in evenmesh_gl_off)
    set(program evenmesh_without_gl)
    file(GLOB sources CONFIGURE_DEPENDS src/gl/off/*.cpp)
    add_library(${stand_in} STATIC ${sources} src/gl/is_glsl.cpp)
    target_link_libraries(${stand_in} PUBLIC evenmesh_shape PRIVATE evenmesh_flags)
    set(objects $<TARGET_OBJECTS:evenmesh>)
    foreach(module ${EVENMESH_MODULES})
      if(NOT module STREQUAL "gl")
        list(APPEND objects $<TARGET_OBJECTS:evenmesh_${module}>)
      endif()
    endforeach()
    add_executable(${program} ${objects})
    set_target_properties(${program} PROPERTIES LINKER_LANGUAGE CXX)
    set(libraries ${EVENMESH_LIBRARIES})
    list(REMOVE_ITEM libraries PkgConfig::EPOXY)
    target_link_libraries(${program} PRIVATE evenmesh_flags ${stand_in} ${libraries})
  endif()
  evenmesh_test(without_gl ${stand_in})
  target_sources(test_without_gl PRIVATE tests/cli/program.cpp)
  target_compile_definitions(test_without_gl PRIVATE EVENMESH_PROGRAM="$<TARGET_FILE:${program}>")
  add_dependencies(test_without_gl ${program})
endif()

# Somebody else's project: finds the installed package, builds the examples and README.md's C++ against it, runs them.
if(NOT EVENMESH_SANITIZE)
  add_test(NAME package.consumer
           COMMAND ${CMAKE_COMMAND} -DBUILD=${CMAKE_BINARY_DIR} -DSOURCE=${PROJECT_SOURCE_DIR}
                   -DGENERATOR=${CMAKE_GENERATOR} -DCOMPILER=${CMAKE_CXX_COMPILER}
                   -P ${PROJECT_SOURCE_DIR}/tests/consumer/run.cmake)
  set_tests_properties(package.consumer PROPERTIES TIMEOUT 300)
endif()
