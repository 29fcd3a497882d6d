# Writes OUT: a table of the files in SOURCES as C++ string literals (stdlib/sources.h).
file(WRITE ${OUT}.tmp "#include \"stdlib/sources.h\"\nnamespace stdlib {\nstatic constexpr LibrarySource kSources[] = {\n")
foreach(source ${SOURCES})
  get_filename_component(name ${source} NAME)
  file(READ ${source} text)
  file(APPEND ${OUT}.tmp "{\"<stdlib>/${name}\", R\"st~(${text})st~\"},\n")
endforeach()
file(APPEND ${OUT}.tmp "};\nstd::span<const LibrarySource> library_sources() { return kSources; }\n}\n")
file(RENAME ${OUT}.tmp ${OUT})
