# Run at the start of every build: cmake -D SOURCE=... -D OUT=... -D VERSION=... -P WriteVersion.cmake
# Writes the definitions of core/version.h, and touches the file only when they changed.
set(commit "")
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${GIT} -C ${SOURCE} describe --always --exclude=* --abbrev=10 --dirty=+
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed ERROR_QUIET)
  if(failed)
    set(commit "")
  endif()
endif()
set(text "#include \"core/version.h\"

namespace turbid {

std::string_view version() { return \"${VERSION}\"; }
std::string_view version_commit() { return \"${commit}\"; }

}  // namespace turbid
")
if(EXISTS ${OUT})
  file(READ ${OUT} before)
endif()
if(NOT "${before}" STREQUAL "${text}")
  file(WRITE ${OUT} "${text}")
endif()
