# Sources of one folder are compiled several at a time: what they include is parsed once. So names in
# unnamed namespaces are unique in their folder, and in all of frontend/sema. 1: each source alone,
# for work on one of them.
set(STC_BATCH 16 CACHE STRING "Sources that are compiled together")

# These have the same names in each source of the folder, or options of their own.
set(STC_ALONE "/tools/st[a-z]+/main|/small_blocks|/vm/exec/(handle|fused)_")

# stc_batches(RESULT source...): the sources of one folder, or units that include them. With
# STC_BATCH_FOLDER they are of that folder and those in it, and share units. What is compiled small
# (small_sources.cmake) is apart from what is compiled for speed.
function(stc_batches result)
  set(units)
  set(made)
  set(small)
  set(count_small 0)
  set(count_fast 0)
  foreach(source ${ARGN})
    if(STC_BATCH LESS 2 OR source MATCHES "${STC_ALONE}")
      list(APPEND units ${source})
      continue()
    endif()
    cmake_path(RELATIVE_PATH source BASE_DIRECTORY ${CMAKE_SOURCE_DIR} OUTPUT_VARIABLE path)
    cmake_path(GET path PARENT_PATH folder)
    if(DEFINED STC_BATCH_FOLDER)
      set(folder ${STC_BATCH_FOLDER})
    endif()
    set(kind fast)
    if(source IN_LIST STC_SMALL)
      set(kind small)
    endif()
    math(EXPR number "${count_${kind}} / ${STC_BATCH}")
    math(EXPR count_${kind} "${count_${kind}} + 1")
    set(unit ${CMAKE_BINARY_DIR}/generated/batches/${folder}/${kind}_${number}.cc)
    string(APPEND content_${kind}_${number} "#include \"${path}\"\n")
    list(APPEND made ${kind}_${number})
    list(APPEND units ${unit})
    if(kind STREQUAL "small")
      list(APPEND small ${unit})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES made)
  foreach(unit ${made})
    file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/batches/${folder}/${unit}.cc
         CONTENT "${content_${unit}}" @ONLY)
  endforeach()
  list(REMOVE_DUPLICATES units)
  if(small)
    list(REMOVE_DUPLICATES small)
    stc_compile_small(${small})
  endif()
  set(${result} ${units} PARENT_SCOPE)
endfunction()
