#!/bin/sh
# compare.sh FOLDER [NAME "COMPILER AND HOST"]...: compares the files of write.sh in each FOLDER/NAME, byte by byte, with
# those of the first, and prints a table. Exit status 1 if anything differs or a host failed.
set -u
all=${1:?usage: compare.sh FOLDER [NAME COMPILER]...}
shift
first=""
bad=0

# differing A B: prints the names of files that differ or that only one of the two folders has
differing() {
    diff -rq "$1" "$2" | sed -e 's/^Files .*\/\([^/ ]*\) and .* differ$/\1/' -e 's/^Only in .*: //' | sort -u
}

# verdict COUNT: prints the table entry for this number of differing files
verdict() {
    [ "$1" -eq 0 ] && echo equal || echo "$1 differ"
}

printf '| %-8s | %-44s | %-10s | %-12s | %-10s | %4s |\n' host compiler scenes mechanisms hashes s
printf '|---|---|---|---|---|---|\n'
notes=$all/differences.txt
: >"$notes"
while [ $# -ge 2 ]; do
    name=$1
    compiler=$2
    shift 2
    here=$all/$name
    [ -n "$first" ] || first=$here
    for part in scenes mechanisms; do
        differing "$first/$part" "$here/$part" >"$here/$part.differ"
    done
    diff "$first/hashes.txt" "$here/hashes.txt" | sed -n 's/^[<>] scene \([^ ]*\).*/\1/p' | sort -u >"$here/hashes.differ"
    scenes=$(wc -l <"$here/scenes.differ")
    mechanisms=$(wc -l <"$here/mechanisms.differ")
    hashes=$(wc -l <"$here/hashes.differ")
    written=$(find "$here/mechanisms" -name '*.txt' | wc -l)
    if [ -e "$here/failed" ] || [ ! -s "$here/seconds" ] || [ "$written" -eq 0 ]; then
        { echo "$name failed:"; grep -B 2 '^exit status' "$here/log.txt" | head -n 8; } | sed '2,$s/^/    /' >>"$notes"
        bad=1
    fi
    for part in scenes mechanisms hashes; do
        [ -s "$here/$part.differ" ] || continue
        bad=1
        echo "$name, $part: $(head -n 8 "$here/$part.differ" | tr '\n' ' ')" >>"$notes"
    done
    printf '| %-8s | %-44s | %-10s | %-12s | %-10s | %4s |\n' "$name" "$compiler" "$(verdict "$scenes")" \
        "$(verdict "$mechanisms")" "$(verdict "$hashes")" "$(cat "$here/seconds")"
done
echo
echo "$(find "$first/scenes" -name '*.c' ! -name scenes.c | wc -l) scenes as C; $(find "$first/mechanisms" -name '*.txt' | wc -l) generated mechanisms as text, LaTeX and Octave," \
    "$(find "$first/mechanisms" -name '*.c' ! -name scenes.c | wc -l) of them as C; $(grep -c '^scene' "$first/hashes.txt") state hashes."
cat "$notes"
[ "$bad" -eq 0 ] || { echo "The program that is generated depends on where it is generated."; exit 1; }
