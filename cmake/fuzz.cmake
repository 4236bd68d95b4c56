# Fuzzers (libFuzzer, needs clang), one per fuzz/fuzz_NAME.cpp:
#
#   cmake --preset fuzz
#   cmake --build --preset fuzz --target fuzzers
#   mkdir -p found && build-fuzz/fuzz_ply found tests/corpus/ply -max_total_time=300 -malloc_limit_mb=256
if(EVENMESH_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "EVENMESH_FUZZ needs clang: configure with -DCMAKE_CXX_COMPILER=clang++")
  endif()
  # What the fuzzers look at tells them where they were; the other modules, which only tests run here, stay nearly twice as fast.
  # -fsanitize=fuzzer brings main() and belongs to the fuzzers alone.
  foreach(module ${EVENMESH_MODULES})
    if(module MATCHES "^(core|geometry|shape|io|gl|scene)$")
      target_compile_options(evenmesh_${module} PRIVATE -fsanitize-coverage=inline-8bit-counters,pc-table,indirect-calls,trace-cmp)
    endif()
  endforeach()
  add_custom_target(fuzzers)
  file(GLOB fuzz_sources CONFIGURE_DEPENDS fuzz/fuzz_*.cpp)
  if(NOT EVENMESH_GL)
    list(FILTER fuzz_sources EXCLUDE REGEX "fuzz_glsl")
  endif()
  foreach(source ${fuzz_sources})
    get_filename_component(name ${source} NAME_WE)
    add_executable(${name} EXCLUDE_FROM_ALL ${source})
    target_include_directories(${name} PRIVATE include src)
    target_link_options(${name} PRIVATE -fsanitize=fuzzer)
    set(modules "")
    foreach(module ${EVENMESH_MODULES})
      if(module MATCHES "^(scene|gl|io|shape)$")
        list(APPEND modules evenmesh_${module})
      endif()
    endforeach()
    target_link_libraries(${name} PRIVATE evenmesh_flags ${modules})
    add_dependencies(fuzzers ${name})
  endforeach()
endif()
