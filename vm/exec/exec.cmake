# g++ has no macro that tells of -fsanitize=undefined, so the form without tail calls
# (vm/exec/context.h) is chosen here whenever code is instrumented; or not optimised, where tail
# calls are calls.
if(STC_SANITIZE OR STC_COVERAGE OR CMAKE_BUILD_TYPE STREQUAL "Quick")
  set(STC_AS_WRITTEN ON)
endif()
if(STC_AS_WRITTEN)
  add_compile_definitions(STC_TAIL_CALLS=0)
endif()
if(NOT STC_FUSIONS)
  add_compile_definitions(STC_NO_FUSIONS)
endif()

# Handlers neither throw nor are they thrown through: what would unwind them is a tenth of stvm.
if(NOT STC_AS_WRITTEN)
  file(GLOB handlers ${CMAKE_SOURCE_DIR}/vm/exec/handle_*.cc ${CMAKE_SOURCE_DIR}/vm/exec/fused_*.cc)
  stc_compile_with(handler_headers
    "-fno-exceptions;-fno-unwind-tables;-fno-asynchronous-unwind-tables"
    HEADERS ${STC_COMMON_HEADERS} SOURCES ${handlers})
endif()
