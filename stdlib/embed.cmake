# Writes OUT: a table of the files in SOURCES as C++ string literals (stdlib/sources.h).
#
# A file with lines `(* VARIANT _SUFFIX old=new ... *)` is written once more for each of them, with every
# `old` replaced by `new` and the suffix after the name of every POU: one source for all types.
function(embed name text)
  file(APPEND ${OUT}.tmp "{\"<stdlib>/${name}.st\", R\"st~(${text})st~\"},\n")
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
  string(REGEX REPLACE "(FUNCTION_BLOCK|FUNCTION) ([A-Za-z0-9_]+)" "\\1 \\2${suffix}" text "${text}")
  string(TOLOWER "${suffix}" suffix)
  embed("${name}${suffix}" "${text}")
endfunction()

file(WRITE ${OUT}.tmp "#include \"stdlib/sources.h\"\nnamespace stdlib {\nstatic constexpr LibrarySource kSources[] = {\n")
foreach(source ${SOURCES})
  get_filename_component(name ${source} NAME_WE)
  file(READ ${source} text)
  string(REGEX MATCHALL "\\(\\* VARIANT [^*]*\\*\\)" variants "${text}")
  string(REGEX REPLACE "\\(\\* VARIANT [^*]*\\*\\)\n" "" text "${text}")
  embed("${name}" "${text}")
  foreach(variant ${variants})
    string(REGEX REPLACE "\\(\\* VARIANT ([^*]*)\\*\\)" "\\1" variant "${variant}")
    embed_variant("${name}" "${text}" "${variant}")
  endforeach()
endforeach()
file(APPEND ${OUT}.tmp "};\nstd::span<const LibrarySource> library_sources() { return kSources; }\n}\n")
file(RENAME ${OUT}.tmp ${OUT})
