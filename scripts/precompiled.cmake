# Parsing headers of the standard library is a quarter of a build. With STC_PRECOMPILED they are parsed
# once for each way of compiling: what is shipped for speed, what is shipped small, and the tests.
# No header of the project: what changes often would compile everything anew, and measured on 16
# sources it saves nothing more. `make clang` compiles each source with what it includes itself.
set(STC_COMMON_HEADERS
  <algorithm> <array> <atomic> <bit> <charconv> <chrono> <cmath> <cstdint> <cstdio> <cstdlib>
  <cstring> <functional> <limits> <map> <memory> <mutex> <optional> <set> <span> <string>
  <string_view> <thread> <unordered_map> <utility> <variant> <vector>)

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

# stc_compile_small(source...): for size rather than for speed in a release build.
function(stc_compile_small)
  if(NOT CMAKE_BUILD_TYPE STREQUAL "Release")
    return()
  endif()
  set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS -Os)
  if(STC_PRECOMPILED)
    if(NOT TARGET small_headers)
      stc_precompiled_headers(small_headers ${STC_COMMON_HEADERS})
      target_compile_options(small_headers PRIVATE -Os)
    endif()
    # A target reuses the headers of one other target; these sources are in many.
    set(header ${CMAKE_BINARY_DIR}/CMakeFiles/small_headers.dir/cmake_pch.hxx)
    set_property(SOURCE ${ARGN} PROPERTY SKIP_PRECOMPILE_HEADERS ON)
    set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS -Winvalid-pch -include ${header})
    set_property(SOURCE ${ARGN} APPEND PROPERTY OBJECT_DEPENDS ${header}.gch)
  endif()
endfunction()
