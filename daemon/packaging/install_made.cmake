# Installs what is made of the program itself. Needs: units, man_dir, run (the command that starts recald).

# to(PATH VARIABLE): where a path relative to the prefix is installed.
function(to path variable)
  if(NOT IS_ABSOLUTE "${path}")
    set(path "${CMAKE_INSTALL_PREFIX}/${path}")
  endif()
  set(${variable} "$ENV{DESTDIR}${path}" PARENT_SCOPE)
endfunction()

# install_printed(PATH ARGUMENTS…): what `recald ARGUMENTS…` prints.
function(install_printed path)
  to("${path}" file)
  execute_process(COMMAND ${run} ${ARGN} OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  file(WRITE "${file}" "${text}")
  message(STATUS "Installing: ${file}")
endfunction()

set(unit_dir lib/systemd/system)
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(unit_dir /lib/systemd/system)  # where Debian 12 looks for units of packages
endif()
to("${unit_dir}" folder)
foreach(unit ${units})
  get_filename_component(name "${unit}" NAME)
  file(READ "${unit}" text)
  string(REPLACE "/usr/bin/recald" "${CMAKE_INSTALL_PREFIX}/bin/recald" text "${text}")
  file(WRITE "${folder}/${name}" "${text}")
  message(STATUS "Installing: ${folder}/${name}")
endforeach()

execute_process(COMMAND ${run} --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "\n  [a-z]+  " commands "${help}")
install_printed("${man_dir}/man1/recald.1" man)
foreach(command ${commands})
  string(STRIP "${command}" command)
  install_printed("${man_dir}/man1/recald-${command}.1" man ${command})
endforeach()

install_printed(share/bash-completion/completions/recald completion bash)
install_printed(share/fish/vendor_completions.d/recald.fish completion fish)
# Where zsh looks for what the system brought, and for what was added to it.
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  install_printed(share/zsh/vendor-completions/_recald completion zsh)
else()
  install_printed(share/zsh/site-functions/_recald completion zsh)
endif()
