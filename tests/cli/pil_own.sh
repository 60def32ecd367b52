#!/bin/sh
# pil_own.sh: the pair of docs/pil.md, "A firmware of one's own": plant, firmware and commands are taken from that page, built
# with gcc and clang, and run on tables that are drawn; where the table stands at the end is asked of the plant. Then the same
# firmware with one bug each, which a run must tell of. WHIRL_FULL: more tables.
. "$(dirname "$0")/../checks.sh"

# block WORD: what the page's section has in blocks of that kind
block() {
    awk -v fence="\`\`\`$1" '/^## / { section = /A firmware of one/ } $0 == fence { into = section; next } /^```/ { into = 0 } into' docs/pil.md
}
block whirl >"$scratch/table.whirl"
block c >"$scratch/pil_table.c"
block sh >"$scratch/commands"
[ "$(wc -l <"$scratch/table.whirl")" -gt 10 ] && [ "$(wc -l <"$scratch/pil_table.c")" -gt 30 ]
verdict $? "docs/pil.md has a plant and a firmware"

# build COMPILER SOURCE PROGRAM: with the page's words, but for compiler, paths and warnings
build() {
    words=$(tr -d '\\' <"$scratch/commands" | awk '/^cc / { on = 1 } /^build/ { on = 0 } on' | tr '\n' ' ' |
        sed "s,^cc,$1 -Wall -Wextra -Wconversion -Wshadow -Werror,; s,boards/programs/pil_table.c,$2,; s,-o build/pil_table,-o $3,")
    # shellcheck disable=SC2086 # words
    $words 2>"$scratch/err"
}
built=
for compiler in gcc clang; do
    command -v $compiler >/dev/null 2>&1 || continue
    build $compiler "$scratch/pil_table.c" "$scratch/$compiler"
    verdict $? "$compiler builds it without a warning"
    built=$scratch/$compiler
done
[ -n "$built" ]
verdict $? "there is a compiler"

# run PROGRAM WORD...: against the page's plant
run() {
    program=$1
    shift
    sh tests/limit.sh 60 "$whirl" pil "$scratch/table.whirl" --firmware "$program" "$@" >"$scratch/out" 2>"$scratch/err"
}
# the page's own runs, in its order
grep '^build/whirl pil' "$scratch/commands" | sed 's/^build.whirl pil table.whirl --firmware build.pil_table//' >"$scratch/runs"
[ "$(wc -l <"$scratch/runs")" -eq 2 ]
verdict $? "the page runs it twice"
while read -r words; do
    # shellcheck disable=SC2086 # words
    run "$built" $words --tape "$scratch/tape" && grep -q '^it tells  *homed 1, place ' "$scratch/out"
    verdict $? "as on the page: $words" "$scratch/out"
done <"$scratch/runs"

tables=1
[ -z "${WHIRL_FULL:-}" ] || tables=20
awk -v seed="${WHIRL_SEED:-1}" -v n=$tables 'BEGIN { srand(seed); for (i = 0; i < n; i++)
    printf "%.3f %.2f %.4f\n", 2 + 13 * rand(), 1 + 6 * rand(), 0.001 + 0.009 * rand() }' >"$scratch/drawn"
while read -r x m rub; do
    run "$built" --set "x_start=${x}mm" --set "m=$m" --set "rub=$rub" --tape "$scratch/tape"
    verdict $? "a table at $x mm, of $m kg, with $rub N*m, is where it should be"
    # the encoder has 1.25 um a count; a screw of 5 mm
    "$whirl" pil --read "$scratch/tape" | awk -F, -v x="$x" '$5 == "theta" && $3 == "sample" { a = $6 }
        END { d = x + 5 * a / 6.28318530718 - 20; exit !(a != "" && d < 0.02 && d > -0.02) }'
    verdict $? "the plant says so, too"
done <"$scratch/drawn"

# bug NAME STATUS PATTERN SED: the firmware with that change ends so, and the run says why
bug() {
    sed "$4" "$scratch/pil_table.c" >"$scratch/$1.c"
    ! cmp -s "$scratch/pil_table.c" "$scratch/$1.c" && build "${built##*/}" "$scratch/$1.c" "$scratch/$1"
    verdict $? "$1: builds"
    run "$scratch/$1"
    [ $? -eq "$2" ] && grep -q "$3" "$scratch/err"
    verdict $? "$1: status $2, $3" "$scratch/err"
}
bug no_number 1 "set 'u' to what is no number (NaN) at t = 0.1 s" 's/wanted - rate) + sum)/wanted - rate) + sum + (period < 100U ? 0.0f : rate * 0.0f \/ (rate * 0.0f)))/'
bug stands_still 1 'time stands still at t = 0 s' 's/period \* PERIOD); .*/0U); period = 1U;/'
exit $failed
