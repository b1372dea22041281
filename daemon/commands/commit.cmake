# The commit that recald doctor says: RECALD_COMMIT, else that of the checkout, where git knows one. A new
# commit makes one small header anew; run as a script, this file writes it.

function(write_commit header commit)
  file(WRITE ${header} "#pragma once\n\nnamespace recald::daemon {\n\n"
    "inline constexpr const char* kCommitText = \"${commit}\";\n\n}  // namespace recald::daemon\n")
endfunction()

if(CMAKE_SCRIPT_MODE_FILE)
  execute_process(COMMAND ${GIT} rev-parse --short=12 HEAD WORKING_DIRECTORY ${SOURCE}
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  write_commit(${HEADER} "${commit}")
  return()
endif()

set(commit_header ${CMAKE_BINARY_DIR}/generated/daemon/commands/commit_text.hpp)
set(commit_moves "")  # the files that change with each commit
find_package(Git QUIET)
if(RECALD_COMMIT STREQUAL "" AND GIT_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} rev-parse --show-toplevel --git-path HEAD --git-path logs/HEAD
    WORKING_DIRECTORY ${CMAKE_SOURCE_DIR} OUTPUT_VARIABLE said OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  string(REPLACE "\n" ";" said "${said}")
  list(POP_FRONT said top)
  get_filename_component(source ${CMAKE_SOURCE_DIR} REALPATH)
  if(top STREQUAL source)  # and not the checkout of somebody else around an unpacked archive
    foreach(file ${said})
      get_filename_component(file "${file}" ABSOLUTE BASE_DIR ${CMAKE_SOURCE_DIR})
      if(EXISTS ${file})
        list(APPEND commit_moves ${file})
      endif()
    endforeach()
  endif()
endif()
if(commit_moves)
  add_custom_command(OUTPUT ${commit_header}
    COMMAND ${CMAKE_COMMAND} -DGIT=${GIT_EXECUTABLE} -DSOURCE=${CMAKE_SOURCE_DIR} -DHEADER=${commit_header}
      -P ${CMAKE_CURRENT_LIST_FILE}
    DEPENDS ${commit_moves} ${CMAKE_CURRENT_LIST_FILE} COMMENT "Looking up the commit" VERBATIM)
else()
  write_commit(${commit_header} "${RECALD_COMMIT}")
endif()
target_sources(recald_daemon PRIVATE commands/commit.cpp ${commit_header})
