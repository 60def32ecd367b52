#!/bin/sh
# recorded_lists.sh: the operation lists of every scene, with and without compensated sums, and of generated
# mechanisms are those on record in tests/reference/lists.txt: the number of operations (the price) and a checksum of
# the text (the bits). The same is true of the models' hashes. To change them, run `WHIRL=build/whirl sh
# tests/cli/recorded_lists.sh --write`, and say in CHANGELOG.md what changed and why. Other tests check that they are
# right.
. "$(dirname "$0")/../checks.sh"

here=$(dirname "$0")
record=$here/../reference/lists.txt
count=48

# lists FILE: prints the operations of a generated file, one a line.
lists() { grep -hE '^ +(const wh_real [a-z][0-9]+ =|[a-z_]+\[[0-9]+\] = |wh_sincos(_parts)?\()' "$1"; }

# line NAME FILE: prints the name, the number of operations, and the checksum of their text
line() {
    lists "$2" >"$scratch/lists" || true
    echo "$1 $(wc -l <"$scratch/lists") $(cksum <"$scratch/lists" | cut -d ' ' -f 1)"
}

mkdir "$scratch/scenes"
"$whirl" emit-scenes "$scratch/scenes" >"$scratch/out" 2>&1
verdict $? "every scene is written as C"
for file in "$scratch"/scenes/*.c; do
    name=$(basename "$file" .c)
    [ "$name" = scenes ] || line "$name" "$file"
done >"$scratch/now"

# With compensated sums, factors are searched for and multiplied in (host/image/op_list_scaling.h).
good=0
for name in $("$whirl" list | tr -d '\r' | awk '$1 == "scene" { print $2 }'); do
    "$whirl" derive "$name" --as c --compensated >"$scratch/made.c" 2>>"$scratch/out" || good=1
    line "${name}_compensated" "$scratch/made.c"
    "$whirl" describe "$name" --json >"$scratch/made.json" 2>>"$scratch/out" || good=1
    echo "$name $(tr -d '\r' <"$scratch/made.json" | sed -n 's/^ *"hash": "\(0x[0-9a-f]*\)".*/\1/p')" # by which programs know the model
done >>"$scratch/now"
verdict $good "every scene is derived with compensated sums"

good=0
number=0
while [ "$number" -lt "$count" ]; do
    "$whirl" derive "$here/../reference/generated.whirl:s$number" --as c >"$scratch/made.c" 2>>"$scratch/out" || good=1
    line "generated_$number" "$scratch/made.c"
    number=$((number + 1))
done >>"$scratch/now"
verdict $good "$count generated mechanisms are derived"

if [ "${1:-}" = --write ]; then
    cp "$scratch/now" "$record"
fi
diff "$record" "$scratch/now" >"$scratch/diff"
verdict $? "operations and their text are those on record ($(wc -l <"$record") lists)"
sed "s/^/    /" "$scratch/diff" | head -n 20
exit $failed
