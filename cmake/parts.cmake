# The installed library (all rooms in one archive), the program, tests, benchmarks, fuzzers.

# One test program per folder of tests/; it links the room of the same name, or everything.
if(EVENMESH_TESTS)
  enable_testing()
  find_package(GTest REQUIRED)
  include(GoogleTest)
  foreach(room ${EVENMESH_ROOMS})
    file(GLOB sources CONFIGURE_DEPENDS tests/${room}/*.cpp)
    if(sources)
      add_executable(test_${room} ${sources})
      target_include_directories(test_${room} PRIVATE tests)
      target_link_libraries(test_${room} PRIVATE evenmesh_flags evenmesh_${room} GTest::gtest_main)
      target_compile_definitions(test_${room} PRIVATE EVENMESH_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
      gtest_discover_tests(test_${room} TEST_PREFIX ${room}. DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60)
    endif()
  endforeach()
endif()
