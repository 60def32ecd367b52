#!/bin/sh
# doc_examples.sh: every ```whirl block of the documents is a complete file that derives; the C program of
# docs/language.md builds as its commands there say, and prints what stands below them.
. "$(dirname "$0")/../checks.sh"

count=0

for document in README.md docs/*.md; do
    [ -f "$document" ] || continue
    awk -v stem="$scratch/$(basename "$document" .md)" '
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

# --- the program built by hand: main.c, the pendulum, the commands that follow, the line that they print
mkdir "$scratch/hand"
ln -s "$PWD/core" "$scratch/hand/core"
mkdir "$scratch/hand/build"
ln -s "$(realpath "$whirl")" "$scratch/hand/build/whirl"
awk -v into="$scratch/hand" '
    /^```whirl/ { file = pendulum++ ? "" : into "/pendulum.whirl"; next }
    /^```c$/ { file = into "/main.c"; next }
    /^```sh/ && main && !shown { file = into "/commands"; next }
    /^```/ { main = main || file == into "/main.c"; shown = shown || file == into "/commands"; file = ""; next }
    shown && !printed && /^    / { sub(/^    /, ""); print > (into "/wanted"); printed = 1 }
    file != "" { print > file }' docs/language.md
(cd "$scratch/hand" && sh -e commands) >"$scratch/hand/said" 2>"$scratch/err"
verdict $? "docs/language.md: main.c and the generated scene build and run"
cmp "$scratch/hand/said" "$scratch/hand/wanted" 2>"$scratch/err"
verdict $? "docs/language.md: they print what it says"
hash=$(sed -n 's/.*state hash //p' "$scratch/hand/said")
"$whirl" run "$scratch/hand/pendulum.whirl:pendulum_swing" --number float | grep -q "^state hash *${hash:-none}\$"
verdict $? "docs/language.md: the state hash is the interpreter's"
for flag in -DWH_DOUBLE=0 -DWH_DOUBLE=1; do
    (cd "$scratch/hand" && cc -std=c11 -O1 -Wall -Wextra -Wconversion -Wshadow -Werror -ffp-contract=off $flag -I. \
        -o strict main.c swing.c core/scene.c core/angle.c && ./strict) >/dev/null 2>"$scratch/err"
    verdict $? "docs/language.md: without a warning, $flag"
done

[ "$count" -ge 4 ]
verdict $? "$count examples found (run from the project's root)" /dev/null
exit $failed
