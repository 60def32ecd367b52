#!/bin/sh
# asked_first.sh: what one process writes of all scenes, one after the other, is what a process of its own writes of each:
# every built-in scene, and generated mechanisms of one file. (Inside one algebra: tests/host/test_asked_first.c.)
. "$(dirname "$0")/../checks.sh"

mkdir "$scratch/all" "$scratch/of_file"
"$whirl" emit-scenes "$scratch/all"
verdict $? "all scenes are written in one go"

# alone FOLDER TARGET...: the names of files in FOLDER that `derive --as c` writes differently
alone() {
    for file in "$1"/*.c; do
        name=$(basename "$file" .c)
        [ "$name" != scenes ] || continue
        "$whirl" derive "$2$name" --as c 2>&1 | cmp -s - "$file" || echo "$name"
    done
}

alone "$scratch/all" "" >"$scratch/found"
[ ! -s "$scratch/found" ] && [ "$(find "$scratch/all" -name '*.c' | wc -l)" -gt 60 ]
verdict $? "each built-in scene alone is the same to the byte" "$scratch/found"

"$(dirname "$whirl")/tools/mechanisms" 25 7 >"$scratch/made.whirl" 2>"$scratch/said"
verdict $? "$(cat "$scratch/said")"
"$whirl" emit-scenes "$scratch/of_file" "$scratch/made.whirl"
verdict $? "all of them are written in one go"
alone "$scratch/of_file" "$scratch/made.whirl:" >"$scratch/found"
[ ! -s "$scratch/found" ] && [ "$(find "$scratch/of_file" -name '*.c' | wc -l)" -gt 5 ]
verdict $? "each of them alone is the same to the byte" "$scratch/found"

exit $failed
