# Parsing headers of the standard library is a quarter of a build. With STC_PRECOMPILED they are parsed
# once for each way of compiling: what is shipped for speed, what is shipped small, and the tests.
# No header of the project: what changes often would compile everything anew, and measured on 16
# sources it saves nothing more. `make clang` compiles each source with what it includes itself.
set(STC_COMMON_HEADERS
  <algorithm> <array> <bit> <cstdint> <cstdio> <cstdlib> <cstring> <functional> <limits> <map>
  <memory> <optional> <set> <span> <string> <string_view> <unordered_map> <utility> <vector>)
# Reading what was parsed takes time, too: these only where threads are.
set(STC_THREAD_HEADERS <atomic> <charconv> <chrono> <cmath> <mutex> <thread> <variant>)

# stc_precompiled_headers(NAME header...): what stc_precompiled(TARGET NAME) takes part in.
function(stc_precompiled_headers name)
  set(empty ${CMAKE_BINARY_DIR}/generated/${name}.cc)
  file(CONFIGURE OUTPUT ${empty} CONTENT "")
  add_library(${name} OBJECT ${empty})
  target_precompile_headers(${name} PRIVATE ${ARGN})
  # What ccache takes for their content: made anew, the file differs, though it means the same.
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/${name}.dir/cmake_pch.hxx.gch.sum
       CONTENT "${ARGN} ${CMAKE_CXX_COMPILER_VERSION}")
endfunction()

function(stc_precompiled target name)
  if(STC_PRECOMPILED)
    target_precompile_headers(${target} REUSE_FROM ${name})
  endif()
endfunction()

# stc_compile_with(NAME options HEADERS header... SOURCES source...): these sources with these options,
# and with these headers parsed with the same options, as NAME.
function(stc_compile_with name options)
  cmake_parse_arguments(ARG "" "" "HEADERS;SOURCES" ${ARGN})
  set_property(SOURCE ${ARG_SOURCES} APPEND PROPERTY COMPILE_OPTIONS ${options})
  if(NOT STC_PRECOMPILED)
    return()
  endif()
  if(NOT TARGET ${name})
    stc_precompiled_headers(${name} ${ARG_HEADERS})
    target_compile_options(${name} PRIVATE ${options})
  endif()
  # A target reuses the headers of one other target; these sources are in many.
  set(header ${CMAKE_BINARY_DIR}/CMakeFiles/${name}.dir/cmake_pch.hxx)
  set_property(SOURCE ${ARG_SOURCES} PROPERTY SKIP_PRECOMPILE_HEADERS ON)
  set_property(SOURCE ${ARG_SOURCES} APPEND PROPERTY COMPILE_OPTIONS -Winvalid-pch
                                                                     -include ${header})
  set_property(SOURCE ${ARG_SOURCES} APPEND PROPERTY OBJECT_DEPENDS ${header}.gch)
endfunction()

# stc_compile_small(source...): for size rather than for speed in a release build.
function(stc_compile_small)
  if(CMAKE_BUILD_TYPE STREQUAL "Release")
    stc_compile_with(small_headers -Oz HEADERS ${STC_COMMON_HEADERS} ${STC_THREAD_HEADERS}
                     SOURCES ${ARGN})
  endif()
endfunction()

# stc_compile_client(source...): likewise, for verbs of `stvm` that ask a controller. When memory runs
# out in one, it ends; there is nothing to clean up. A controller goes on (base/memory_limit.h).
function(stc_compile_client)
  if(CMAKE_BUILD_TYPE STREQUAL "Release")
    stc_compile_with(client_headers "-Oz;-fno-exceptions"
                     HEADERS ${STC_COMMON_HEADERS} ${STC_THREAD_HEADERS} SOURCES ${ARGN})
  endif()
endfunction()

# stc_compiler_only(TARGET): what is only in `stc`. Nothing there is caught or cleaned up when memory
# runs out (tools/stc/memory_budget.h), and half of the optimiser's time is for a hundredth of the
# speed (docs/TESTING.md, Build time).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_BUILD_TYPE STREQUAL "Release")
  set(STC_COMPILER_OPTIONS -O1 -finline-small-functions -findirect-inlining -fpartial-inlining
                           -fno-exceptions)
endif()
function(stc_compiler_only target)
  if(NOT STC_COMPILER_OPTIONS)
    stc_precompiled(${target} product_headers)
    return()
  endif()
  target_compile_options(${target} PRIVATE ${STC_COMPILER_OPTIONS})
  if(STC_PRECOMPILED AND NOT TARGET compiler_headers)
    stc_precompiled_headers(compiler_headers ${STC_COMMON_HEADERS})
    target_compile_options(compiler_headers PRIVATE ${STC_COMPILER_OPTIONS})
  endif()
  stc_precompiled(${target} compiler_headers)
endfunction()
