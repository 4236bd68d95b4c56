# The installed library (all modules in one archive), the program, tests, benchmarks, fuzzers.
include(CMakePackageConfigHelpers)

# The library: one archive, so that whoever installs it need not know the modules.
set(objects "")
foreach(module ${EVENMESH_MODULES})
  list(APPEND objects $<TARGET_OBJECTS:evenmesh_${module}>)
endforeach()
add_library(evenmesh_library STATIC ${objects})
add_library(evenmesh::evenmesh ALIAS evenmesh_library)
set_target_properties(evenmesh_library PROPERTIES OUTPUT_NAME evenmesh EXPORT_NAME evenmesh LINKER_LANGUAGE CXX)
target_compile_features(evenmesh_library PUBLIC cxx_std_20)
target_include_directories(evenmesh_library INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                                      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
# Header-only libraries are used up by now; the others must be linked by whoever links the archive.
list(REMOVE_DUPLICATES EVENMESH_LIBRARIES)
list(REMOVE_ITEM EVENMESH_LIBRARIES Eigen3::Eigen nlohmann_json::nlohmann_json)
target_link_libraries(evenmesh_library INTERFACE ${EVENMESH_LIBRARIES})

install(TARGETS evenmesh_library EXPORT evenmeshTargets)
install(DIRECTORY include/evenmesh DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(EXPORT evenmeshTargets NAMESPACE evenmesh:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/evenmesh)
configure_package_config_file(cmake/evenmeshConfig.cmake.in evenmeshConfig.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/evenmesh)
write_basic_package_version_file(evenmeshConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/evenmeshConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/evenmeshConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/evenmesh)

# What only some need, and slow to load (src/io/vdb/plugin.h).
if(EVENMESH_OPENVDB)
  add_library(evenmesh_vdb MODULE src/io/vdb/plugin.cpp)
  set_target_properties(evenmesh_vdb PROPERTIES PREFIX "")
  target_include_directories(evenmesh_vdb PRIVATE include src)
  target_link_libraries(evenmesh_vdb PRIVATE evenmesh_flags openvdb Imath)
  install(TARGETS evenmesh_vdb DESTINATION ${CMAKE_INSTALL_LIBDIR}/evenmesh)
endif()

# The program. It sees the public headers only, like any other user of the library.
file(GLOB sources CONFIGURE_DEPENDS apps/cli/*.cpp)
add_executable(evenmesh ${sources})
target_link_libraries(evenmesh PRIVATE evenmesh_flags evenmesh_library CLI11::CLI11 fmt::fmt
                                       nlohmann_json::nlohmann_json)
target_compile_definitions(evenmesh PRIVATE EVENMESH_VERSION="${PROJECT_VERSION}")
target_compile_options(evenmesh PRIVATE $<$<CONFIG:Release>:-O1>)  # of command lines: small and quickly built
# Compiled as two files, since CLI11 takes longer than all of ours.
set_target_properties(evenmesh PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}
                      UNITY_BUILD ${EVENMESH_PRECOMPILE}
                      UNITY_BUILD_BATCH_SIZE 9)
if(TARGET evenmesh_vdb)
  add_dependencies(evenmesh evenmesh_vdb)
endif()
install(TARGETS evenmesh)

if(EVENMESH_TESTS)
  include(cmake/tests.cmake)
endif()

if(EVENMESH_BENCH)
  file(GLOB benches CONFIGURE_DEPENDS bench/*.cpp)
  if(NOT EVENMESH_OPENVDB)
    message(NOTICE "-- without OpenVDB: bench_shell, which runs beside it, is left out")
    list(FILTER benches EXCLUDE REGEX bench_shell)
  endif()
  foreach(source ${benches})
    get_filename_component(name ${source} NAME_WE)
    add_executable(${name} ${source})
    target_include_directories(${name} PRIVATE src)
    target_link_libraries(${name} PRIVATE evenmesh_flags evenmesh_library Eigen3::Eigen benchmark::benchmark_main)
  endforeach()
  if(TARGET bench_shell)
    target_link_libraries(bench_shell PRIVATE openvdb Imath)  # runs beside ours
  endif()
endif()

file(GLOB examples CONFIGURE_DEPENDS examples/*.cpp)
foreach(source ${examples})
  get_filename_component(name ${source} NAME_WE)
  add_executable(example_${name} EXCLUDE_FROM_ALL ${source})
  target_link_libraries(example_${name} PRIVATE evenmesh_flags evenmesh_library)
endforeach()

include(cmake/fuzz.cmake OPTIONAL)
