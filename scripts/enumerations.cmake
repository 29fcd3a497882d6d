# stc_enumeration(TABLE ROW): generated/TABLE.names has `NAME(identifier)` for each `ROW(identifier, ..`
# at the beginning of a line of TABLE. Made when CMake runs, which an edit of the table causes, and
# written when it is another one.
function(stc_enumeration table row)
  set(source ${CMAKE_SOURCE_DIR}/${table})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
  file(READ ${source} text)
  string(REGEX MATCHALL "\n${row}\\([A-Za-z0-9_]+," rows "\n${text}")
  string(REGEX REPLACE "\n${row}\\(([A-Za-z0-9_]+)," "NAME(\\1)\n" names "${rows}")
  string(REPLACE ";" "" names "${names}")
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/${table}.names CONTENT "${names}" @ONLY)
endfunction()
