#!/bin/sh
# Learns the sizes of the models' own errors (core/assessment/model_errors.cpp) on buildings of the simulator with nothing
# hidden in them: those sizes under which their meters are likeliest at the true parameters, every building counting
# alike, and how they differ by use.
#   USES    to learn on   (default office school laboratory)
#   COUNT   of each       (default 15)
#   SEED    of the first  (default 7001)
#   MODELS  (default epc hourly)
#   OUT     where buildings are kept (default: a new folder)
# Argument: the build folder.
set -eu
cmake --build "$1" --target model_errors_study recald-sim
exec python3 "$(dirname "$0")/model_errors.py" "$1"
