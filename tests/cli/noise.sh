#!/bin/sh
# noise.sh: an output's noise in `whirl sweep` is that of `whirl run`, with any jobs and shards, resumed or not, with parameters
# swept or not. build/tests/host noise_measures draws mechanisms and lists of measures.
. "$(dirname "$0")/../checks.sh"

cat >"$scratch/read.whirl" <<'END'
mechanism read "a pendulum that is read badly"
coordinate th [rad]
parameter l = 0.5 [m]
T = 1 [kg]*l^2*th'^2/2
V = -9.81 [m/s^2]*1 [kg]*l*cos(th)
output height [m] = l*(1 - cos(th))
output side [m] = l*sin(th)
output both [m] = height + side
effect sensor { parameter dev = 3 [mm]; noise side deviation dev seed 9; noise both deviation 2*dev }
scene read_badly { with sensor; start th = 1; until 50 [ms] }
END
scene=$scratch/read.whirl:read_badly

# stores column NAME of the last record in $scratch/NAME
for l in 0.4 0.5 0.6 0.7; do
    "$whirl" run "$scene" --set l=$l --csv - --quiet | tr -d '\r' | tail -n 1 | cut -d, -f4-6
done >"$scratch/run"

swept() { "$whirl" sweep "$scene" --over l=0.4..0.7:4 --measure both --measure side "$@" --quiet; }
swept --csv "$scratch/a.csv" --jobs 1
swept --csv - --jobs 3 >"$scratch/b.csv"
check "the same from 3 jobs" cmp "$scratch/a.csv" "$scratch/b.csv"
for k in 1 2 3; do
    swept --csv - --shard $k/3
done >"$scratch/b.csv"
check "the same from shards" cmp "$scratch/a.csv" "$scratch/b.csv"
head -c 60 "$scratch/a.csv" >"$scratch/c.csv"
cp "$scratch/a.csv.sweep" "$scratch/c.csv.sweep"
swept --csv "$scratch/c.csv"
check "the same when gone on with" cmp "$scratch/a.csv" "$scratch/c.csv"
"$whirl" sweep "$scene" --over l=0.4..0.7:4 --csv - --quiet | tr -d '\r' | tail -n +2 | cut -d, -f4-6 >"$scratch/b"
check "all outputs: the bits of the runs" cmp "$scratch/run" "$scratch/b"

# the same with one program for all points, compared with runs without noise
"$whirl" sweep "$scene" --over th=1..1:1 --measure 'max(side)' --measure 'max(2*side)' --measure 'side - l*sin(th)' \
    --csv - --quiet | tr -d '\r' >"$scratch/b"
check "a swept start: noise, and not that of another output" awk -F, \
    'NR == 2 { exit !($2 > 0 && (2*$2 - $3)^2 < 1e-30 && $4 != 0 && $4^2 < 4e-4) }' "$scratch/b"
"$whirl" sweep "$scene" --without sensor --over th=1..1:1 --measure 'side - l*sin(th)' --measure both \
    --measure height+side --csv - --quiet | tr -d '\r' >"$scratch/b"
check "without the sensor: none" awk -F, 'NR == 2 { exit !($2 == 0 && ($3 - $4)^2 < 1e-30) }' "$scratch/b"
exit $failed
