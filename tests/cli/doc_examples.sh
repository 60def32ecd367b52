#!/bin/sh
# doc_examples.sh: every ```whirl block of the documents is a complete file that derives; the C program of
# docs/language.md builds without a warning. (gate-docs runs the commands of all pages.)
. "$(dirname "$0")/../checks.sh"

count=0

for document in README.md docs/*.md docs/dev/*.md; do
    [ -f "$document" ] || continue
    awk -v stem="$scratch/$(echo "$document" | tr / _)" '
        /^```whirl/ { file = stem "-" NR ".whirl"; next }
        /^```/ { file = "" }
        file != "" { print > file }' "$document"
done

for example in "$scratch"/*.whirl; do
    [ -f "$example" ] || continue
    count=$((count + 1))
    name=$(basename "$example" .whirl) # document and line
    "$whirl" derive "$example" >/dev/null 2>"$scratch/err"
    verdict $? "$name"
done

# --- the program built by hand: main.c and the pendulum (gate-docs runs it)
mkdir "$scratch/hand"
ln -s "$PWD/core" "$scratch/hand/core"
awk -v into="$scratch/hand" '
    /^```[a-z]+ [a-z.]+$/ && $2 ~ /[.]/ { file = into "/" $2; next }
    /^```/ { file = "" }
    file != "" { print > file }' docs/language.md
"$whirl" derive "$scratch/hand/pendulum.whirl:pendulum_swing" --as c --header "$scratch/hand/swing.h" >"$scratch/hand/swing.c" 2>"$scratch/err"
verdict $? "docs/language.md: the pendulum as C"
for flag in -DWH_DOUBLE=0 -DWH_DOUBLE=1; do
    (cd "$scratch/hand" && cc -std=c11 -O1 -Wall -Wextra -Wconversion -Wshadow -Werror -ffp-contract=off $flag -I. \
        -o strict main.c swing.c core/scene.c core/angle.c && ./strict) >/dev/null 2>"$scratch/err"
    verdict $? "docs/language.md: without a warning, $flag"
done

[ "$count" -ge 4 ]
verdict $? "$count examples found (run from the project's root)" /dev/null
exit $failed
