# Headers that most files include, read once per group of targets instead of once per file: half of a build's time.
#
#   evenmesh_precompile(TARGET GROUP)    GROUP: modules or tests
#
# Every file still includes what it uses.
option(EVENMESH_PRECOMPILE "precompile common headers, compile the program as few files" ON)

set(precompiled_modules <algorithm> <array> <bit> <cmath> <cstdint> <functional> <limits> <map> <memory> <numbers> <optional>
    <span> <string> <string_view> <unordered_map> <utility> <variant> <vector> <tbb/info.h> <tbb/parallel_for.h>
    <tbb/parallel_sort.h> <tbb/task_arena.h> <fmt/format.h>)
set(precompiled_tests <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <map> <memory> <numbers> <optional>
    <set> <span> <sstream> <string> <variant> <vector> <gtest/gtest.h>)

if(EVENMESH_PRECOMPILE AND EVENMESH_CCACHE)
  # What ccache needs to know of such headers (its manual, "Precompiled headers").
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    add_compile_options(-fpch-preprocess)
  else()
    add_compile_options("SHELL:-Xclang -fno-pch-timestamp")
  endif()
  list(PREPEND CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros)
endif()

function(evenmesh_precompile target group)
  if(NOT EVENMESH_PRECOMPILE)
    return()
  endif()
  get_property(first GLOBAL PROPERTY evenmesh_precompiled_${group})
  if(first)
    target_precompile_headers(${target} REUSE_FROM ${first})
  else()
    target_precompile_headers(${target} PRIVATE ${precompiled_${group}})
    set_property(GLOBAL PROPERTY evenmesh_precompiled_${group} ${target})
  endif()
endfunction()
