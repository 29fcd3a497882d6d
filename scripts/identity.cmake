# Writes OUT, the text of tools/common/version.h: VERSION, and the commit of SOURCE_DIR, with `-changed`
# after it when files differ from that commit. OUT stays untouched when it says so already, so that
# nothing is compiled anew. `unknown` in what is no repository of its own: a tarball.
set(commit unknown)
if(COMMIT)
  set(commit ${COMMIT})
elseif(EXISTS ${SOURCE_DIR}/.git)
  execute_process(COMMAND git describe --always --abbrev=12 --exclude=* --dirty=-changed
    WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE found RESULT_VARIABLE failed ERROR_QUIET
    OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT failed AND found)
    set(commit ${found})
  endif()
endif()
set(text "#include \"tools/common/version.h\"
namespace tools {
const char kVersion[] = \"${VERSION}\";
const char kCommit[] = \"${commit}\";
const char kDocumentation[] = \"${DOCUMENTATION}\";
}  // namespace tools
")
set(old)
if(EXISTS ${OUT})
  file(READ ${OUT} old)
endif()
if(NOT "${old}" STREQUAL "${text}")
  file(WRITE ${OUT} "${text}")
endif()
