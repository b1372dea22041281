#!/bin/sh
# Priors learned from a portfolio, held against the library's: buildings of one fleet with two years of data teach, others of the
# same fleet with a few months are calibrated with both and forecast the next twelve. Then the harm: judged buildings of
# another fleet, priors learned from five, and a fleet as the library expects it. Goes on where it was stopped.
#   USE       of the simulator, of the fleet that teaches  (default office; of the other fleet: school)
#   LEARNING  buildings that teach                        (default 24)
#   JUDGED    buildings of their fleet that are judged    (default 16)
#   OTHERS    judged buildings of another fleet           (default 12)
#   PLAIN     judged buildings of a fleet of the library  (default 0; as many teach as LEARNING says)
#   MONTHS    of data of a judged building                (default "2 3 6")
#   MODEL     epc or hourly                               (default epc)
#   SEED      of the first building                       (default 41001)
#   JOBS      calibrations at a time                      (default 2)
#   OUT       where results are kept                      (default: a new folder)
# Argument: the build folder.
set -eu
cmake --build "$1" --target portfolio_priors_study recald recald-sim >/dev/null
exec python3 "$(dirname "$0")/portfolio_priors.py" "$1"
