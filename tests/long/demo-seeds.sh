#!/bin/sh
# Twenty campus laboratories with nothing wrong in them, truth drawn by seed, one site file: fit before and after, coverage.
# Takes about ten minutes on two cores. Argument: the build folder.
set -eu
build=$1
out=${DEMO_SEEDS_DIR:-$(mktemp -d)}
seeds=${SEEDS:-$(seq 1 20)}
for seed in $seeds; do
  dir=$out/$seed
  mkdir -p "$dir"
  "$build/simulators/recald-sim" building --out "$dir" --years 3 --seed "$seed"
  "$build/daemon/recald" calibrate "$dir/site.toml" --seed "$seed" --out "$dir" >"$dir/table.txt" \
    2>"$dir/log.txt"
  rm -f "$dir/readings.csv" "$dir/weather.csv" "$dir"/draws_*.csv
  echo "seed $seed done"
done
python3 "$(dirname "$0")/summarise_seeds.py" "$out"
echo "details in $out"
