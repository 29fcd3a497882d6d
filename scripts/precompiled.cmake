# Parsing headers is most of a build. With STC_PRECOMPILED (the presets with sanitizers) they are
# parsed twice, once for what is shipped and once for the tests; every other preset compiles each
# source with what it includes itself. Only headers that seldom change and that clash with no name.
set(STC_COMMON_HEADERS
  <algorithm> <array> <atomic> <bit> <charconv> <chrono> <cmath> <cstdint> <cstdio> <cstdlib>
  <cstring> <functional> <limits> <map> <memory> <mutex> <optional> <set> <span> <string>
  <string_view> <thread> <unordered_map> <utility> <variant> <vector>)
foreach(header base/diagnostics.h base/limits.h base/name_case.h base/result.h base/source.h
        ir/types/types.h ir/bytecode/image.h ir/program/ir.h frontend/parse/tree.h
        frontend/sema/sema.h frontend/compile.h linker/link.h vm/runtime/controller.h
        online_change/apply/change.h)
  list(APPEND STC_COMMON_HEADERS ${CMAKE_SOURCE_DIR}/${header})
endforeach()

# stc_precompiled_headers(NAME header...): what stc_precompiled(TARGET NAME) takes part in.
function(stc_precompiled_headers name)
  set(empty ${CMAKE_BINARY_DIR}/generated/${name}.cc)
  file(CONFIGURE OUTPUT ${empty} CONTENT "")
  add_library(${name} OBJECT ${empty})
  target_precompile_headers(${name} PRIVATE ${ARGN})
endfunction()

function(stc_precompiled target name)
  if(STC_PRECOMPILED)
    target_precompile_headers(${target} REUSE_FROM ${name})
  endif()
endfunction()
