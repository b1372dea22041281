# Toolchain file: Debian's compiler for one architecture, with headers and libraries of that architecture in a
# folder (make_sysroot.sh).
#
#   cmake --toolchain daemon/packaging/sysroot.cmake -DRECALD_TRIPLET=aarch64-linux-gnu -DCMAKE_SYSROOT=DIR …
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES RECALD_TRIPLET)
string(REGEX MATCH "^[^-]+" CMAKE_SYSTEM_PROCESSOR ${RECALD_TRIPLET})
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_CXX_COMPILER ${RECALD_TRIPLET}-g++)
set(CMAKE_LIBRARY_ARCHITECTURE ${RECALD_TRIPLET})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
