# g++ has no macro that tells of -fsanitize=undefined, so the form without tail calls
# (vm/exec/context.h) is chosen here whenever code is instrumented.
if(TARGET vm_exec AND (STC_SANITIZE OR STC_COVERAGE))
  target_compile_definitions(vm_exec PRIVATE STC_TAIL_CALLS=0)
endif()
