# Sources of one folder are compiled several at a time: what they include is parsed once. So names in
# unnamed namespaces are unique in their folder, and in all of frontend/sema. 1: each source alone,
# for work on one of them.
set(STC_BATCH 16 CACHE STRING "Sources that are compiled together")
if(STC_BATCH GREATER 1 AND CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  # Names of one source in those of another; without batches it is asked for.
  add_compile_options(-Wno-shadow)
endif()

# These have the same names in each source of the folder, options of their own, or texts that most
# programs do without.
set(STC_ALONE "/tools/st[a-z]+/main|/small_blocks|/diagnostics_pages|/vm/exec/(handle|fused)_")

# stc_batches(RESULT source...): the sources of one folder, or units that include them. With
# STC_BATCH_FOLDER they are of that folder and those in it, and share units. What is compiled small,
# or as a client (small_sources.cmake), is apart from what is compiled for speed.
function(stc_batches result)
  set(units)
  set(made)
  foreach(kind fast small client)
    set(sources_${kind})
    set(units_${kind})
  endforeach()
  foreach(source ${ARGN})
    if(STC_BATCH LESS 2 OR source MATCHES "${STC_ALONE}")
      list(APPEND units ${source})
    elseif(source IN_LIST STC_SMALL)
      list(APPEND sources_small ${source})
    elseif(source IN_LIST STC_CLIENT)
      list(APPEND sources_client ${source})
    else()
      list(APPEND sources_fast ${source})
    endif()
  endforeach()
  foreach(kind fast small client)
    list(LENGTH sources_${kind} count)
    math(EXPR last "(${count} - ${STC_BATCH} / 4 - 1) / ${STC_BATCH}")  # a small rest joins it
    set(index 0)
    foreach(source ${sources_${kind}})
      cmake_path(RELATIVE_PATH source BASE_DIRECTORY ${CMAKE_SOURCE_DIR} OUTPUT_VARIABLE path)
      cmake_path(GET path PARENT_PATH folder)
      if(DEFINED STC_BATCH_FOLDER)
        set(folder ${STC_BATCH_FOLDER})
      endif()
      math(EXPR number "${index} / ${STC_BATCH}")
      math(EXPR index "${index} + 1")
      if(number GREATER last)
        set(number ${last})
      endif()
      set(unit ${CMAKE_BINARY_DIR}/generated/batches/${folder}/${kind}_${number}.cc)
      string(APPEND content_${kind}_${number} "#include \"${path}\"\n")
      list(APPEND made ${kind}_${number})
      list(APPEND units_${kind} ${unit})
    endforeach()
    list(APPEND units ${units_${kind}})
  endforeach()
  list(REMOVE_DUPLICATES made)
  foreach(unit ${made})
    file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/batches/${folder}/${unit}.cc
         CONTENT "${content_${unit}}" @ONLY)
  endforeach()
  list(REMOVE_DUPLICATES units)
  foreach(kind small client)
    if(units_${kind})
      list(REMOVE_DUPLICATES units_${kind})
      cmake_language(CALL stc_compile_${kind} ${units_${kind}})
    endif()
  endforeach()
  set(${result} ${units} PARENT_SCOPE)
endfunction()

# With STC_UNITS the libraries and the tools' sources, but for adapters, are one library `product` of
# so many units of about one size, in the order of the layers. What a template becomes is compiled
# once in a unit: all is there in a third of the time, for who wants to see it run (`make demo`) or
# to know what a compiler says of it (`make clang-read`). So names in unnamed namespaces are unique
# in a namespace, not only in a folder.
if(STC_UNITS)
  add_compile_options(-Wno-shadow)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 12)
    # An eighth of the time: no functions for std::move and its like, and no collection of garbage
    # below a gigabyte.
    add_compile_options(-ffold-simple-inlines "SHELL:--param ggc-min-heapsize=1000000")
  endif()
endif()

# stc_units(RESULT source...)
function(stc_units result)
  set(units)
  set(total 0)
  foreach(source ${ARGN})
    file(SIZE ${source} bytes)
    math(EXPR total "${total} + ${bytes}")
  endforeach()
  set(begin 0)
  foreach(source ${ARGN})
    if(source MATCHES "${STC_ALONE}")
      list(APPEND units ${source})
      continue()
    endif()
    cmake_path(RELATIVE_PATH source BASE_DIRECTORY ${CMAKE_SOURCE_DIR} OUTPUT_VARIABLE path)
    math(EXPR number "${begin} * ${STC_UNITS} / ${total}")
    string(APPEND content_${number} "#include \"${path}\"\n")
    file(SIZE ${source} bytes)
    math(EXPR begin "${begin} + ${bytes}")
  endforeach()
  math(EXPR last "${STC_UNITS} - 1")
  foreach(number RANGE ${last})
    set(unit ${CMAKE_BINARY_DIR}/generated/batches/product_${number}.cc)
    file(CONFIGURE OUTPUT ${unit} CONTENT "${content_${number}}" @ONLY)
    list(INSERT units 0 ${unit})  # they take longest, so they begin first
  endforeach()
  set(${result} ${units} PARENT_SCOPE)
endfunction()
