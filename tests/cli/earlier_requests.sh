#!/bin/sh
# earlier_requests.sh: a process that derives all scenes, one after the other, writes the same C as a process for each scene.
# For every built-in scene, and generated mechanisms in one file. (Within one algebra: tests/host/test_earlier_requests.c.)
. "$(dirname "$0")/../checks.sh"

mkdir "$scratch/all" "$scratch/of_file"
"$whirl" emit-scenes "$scratch/all"
verdict $? "all scenes are written in one go"

# alone FOLDER TARGET...: prints the files in FOLDER that `derive --as c` writes differently.
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
