# Writes OUT: a table of the files in SOURCES as C++ string literals (stdlib/sources.h).
#
# A file with lines `(* VARIANT _SUFFIX old=new ... *)` is written once more for each of them, with every
# `old` replaced by `new` and the suffix after the name of every POU: one source for all types.
# A suffix `L-` stands in front of the name: LTON. With `vendors` in place of the suffix, names stay, and what is written stands for the plain file in
# the dialects of vendors.
# A file that begins with `(* DIALECT Iec *)` or `(* DIALECT Vendors *)` is of the library there only.
function(embed name text dialects)
  declared_names("${text}")
  file(APPEND ${OUT}.tmp
       "{\"<stdlib>/${name}.st\", R\"st~(${text})st~\", LibraryDialects::k${dialects},\n \"${pous}\", \"${types}\"},\n")
endfunction()

# Sets `pous` and `types` to the names that the text declares, separated by blanks. `pous`: the
# names after FUNCTION and FUNCTION_BLOCK. `types`: the words between TYPE and END_TYPE, without
# comments, members of structures, and words after a colon.
function(declared_names text)
  string(REGEX REPLACE "\\(\\*([^*]|\\*[^)])*\\*\\)|//[^\n]*" " " text "${text}")
  string(REGEX MATCHALL "FUNCTION(_BLOCK)? [A-Za-z0-9_]+" heads "${text}")
  string(REGEX REPLACE "FUNCTION(_BLOCK)? |;" " " heads "${heads}")
  string(REGEX REPLACE "STRUCT([^S]|S[^T]|ST[^R]|STR[^U])*END_STRUCT" " " text "${text}")
  string(REGEX MATCHALL "TYPE[ \n]([^E]|E[^N]|EN[^D]|END[^_]|END_[^T])*END_TYPE" parts "${text}")
  string(REGEX REPLACE "END_TYPE|TYPE[ \n]|: *(POINTER TO )?[A-Za-z0-9_]+" " " parts "${parts}")
  string(REGEX MATCHALL "[A-Za-z_][A-Za-z0-9_]*" parts "${parts}")
  string(REPLACE ";" " " parts "${parts}")
  set(pous "${heads}" PARENT_SCOPE)
  set(types "${parts}" PARENT_SCOPE)
endfunction()

# Text goes through as one quoted string: it is full of semicolons, which separate CMake's lists.
function(embed_variant name text variant)
  string(REGEX MATCHALL "[^ ]+" words "${variant}")
  list(POP_FRONT words suffix)
  foreach(word ${words})
    string(FIND "${word}" "=" at)
    string(SUBSTRING "${word}" 0 ${at} old)
    math(EXPR at "${at} + 1")
    string(SUBSTRING "${word}" ${at} -1 new)
    string(REPLACE "${old}" "${new}" text "${text}")
  endforeach()
  if(suffix STREQUAL "vendors")
    embed("${name}" "${text}" Vendors)
    return()
  endif()
  if(suffix MATCHES "^([A-Z]+)-$")
    set(named "${CMAKE_MATCH_1}\\2")
    set(suffix "_${CMAKE_MATCH_1}")
  else()
    set(named "\\2${suffix}")
  endif()
  string(REGEX REPLACE "(FUNCTION_BLOCK|FUNCTION) ([A-Za-z0-9_]+)" "\\1 ${named}" text "${text}")
  string(TOLOWER "${suffix}" suffix)
  embed("${name}${suffix}" "${text}" All)
endfunction()

file(WRITE ${OUT}.tmp "#include \"stdlib/sources.h\"\nnamespace stdlib {\nstatic constexpr LibrarySource kSources[] = {\n")
foreach(source ${SOURCES})
  get_filename_component(name ${source} NAME_WE)
  file(READ ${source} text)
  string(REGEX MATCHALL "\\(\\* VARIANT [^*]*\\*\\)" variants "${text}")
  string(REGEX REPLACE "\\(\\* VARIANT [^*]*\\*\\)\n" "" text "${text}")
  string(REGEX MATCH "^\\(\\* DIALECT ([A-Za-z]+) \\*\\)" only "${text}")
  if(only)
    embed("${name}" "${text}" ${CMAKE_MATCH_1})
  elseif(variants MATCHES "VARIANT vendors ")
    embed("${name}" "${text}" Iec)
  else()
    embed("${name}" "${text}" All)
  endif()
  foreach(variant ${variants})
    string(REGEX REPLACE "\\(\\* VARIANT ([^*]*)\\*\\)" "\\1" variant "${variant}")
    embed_variant("${name}" "${text}" "${variant}")
  endforeach()
endforeach()
file(APPEND ${OUT}.tmp "};\nstd::span<const LibrarySource> library_sources() { return kSources; }\n}\n")
file(RENAME ${OUT}.tmp ${OUT})
