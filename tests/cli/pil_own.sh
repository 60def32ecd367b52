#!/bin/sh
# pil_own.sh: docs/pil.md, "Your own firmware": plant, firmware and commands are taken from that page, built with gcc and
# clang, and run on random tables; the plant gives the table's final place. Then the firmware has one bug at a time, which a
# run must report. WHIRL_FULL: more tables.
. "$(dirname "$0")/../checks.sh"

# block WORD: prints the blocks of that kind in the page's section
block() {
    awk -v fence="\`\`\`$1" '/^## / { section = /Your own firmware/ } $0 == fence { into = section; next } /^```/ { into = 0 } into' docs/pil.md
}
block whirl >"$scratch/table.whirl"
block c >"$scratch/pil_table.c"
block sh >"$scratch/commands"
[ "$(wc -l <"$scratch/table.whirl")" -gt 10 ] && [ "$(wc -l <"$scratch/pil_table.c")" -gt 30 ]
verdict $? "docs/pil.md has a plant and a firmware"

# build COMPILER SOURCE PROGRAM: runs the page's command, except for compiler, paths and warnings
build() {
    words=$(tr -d '\\' <"$scratch/commands" | awk '/^cc / { on = 1 } /^build/ { on = 0 } on' | tr '\n' ' ' |
        sed "s,^cc,$1 -Wall -Wextra -Wconversion -Wshadow -Werror,; s, pil_table.c, $2,; s,-o build/pil_table,-o $3,")
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

# builds the board's image by make, from a folder outside the tree
grep '^make' "$scratch/commands" >"$scratch/makes"
[ "$(wc -l <"$scratch/makes")" -eq 1 ]
verdict $? "the page builds it for a board"
board=$(sed -n 's/.*BOARD=//p' "$scratch/makes")
elf=
if command -v qemu-system-arm >/dev/null 2>&1 && command -v arm-none-eabi-gcc >/dev/null 2>&1; then
    elf=build/$board/own/pil_table.elf
    MAKEFLAGS='' make -s pil-image "CONTROLLER=$scratch/pil_table.c" "BOARD=$board" >"$scratch/err" 2>&1 && [ -f "$elf" ] &&
        [ -f build/own/pil_table ]
    verdict $? "make pil-image builds a controller from outside the tree, for $board and this machine"
fi

# run PROGRAM WORD...: runs the program with the page's plant
run() {
    program=$1
    shift
    sh tests/limit.sh 60 "$whirl" pil "$scratch/table.whirl" --firmware "$program" "$@" >"$scratch/out" 2>"$scratch/err"
}
# the page's own runs, in the order of the page
grep '^build/whirl pil' "$scratch/commands" | sed -n 's/^build.whirl pil table.whirl --firmware build.pil_table//p' >"$scratch/runs"
[ "$(wc -l <"$scratch/runs")" -eq 2 ]
verdict $? "the page runs it twice"
shown=$(grep -o 'homed 1, place [0-9.]* m' docs/pil.md)
while read -r words; do
    run "$built" $words --tape "$scratch/tape" && grep -q "^notes  *$shown" "$scratch/out"
    verdict $? "as on the page: $words" "$scratch/out"
    shown='homed 1, place ' # the page has the first run's place
done <"$scratch/runs"
if [ -n "$elf" ]; then
    run "$elf" && grep -q '^notes  *homed 1, place 0.0[12]' "$scratch/out" && grep -q "board $board" "$scratch/out"
    verdict $? "and on $board" "$scratch/out"
fi

tables=1
[ -z "${WHIRL_FULL:-}" ] || tables=20
awk -v seed="${WHIRL_SEED:-1}" -v n=$tables 'BEGIN { srand(seed); for (i = 0; i < n; i++)
    printf "%.3f %.2f %.4f\n", 2 + 13 * rand(), 1 + 6 * rand(), 0.001 + 0.009 * rand() }' >"$scratch/drawn"
while read -r x m rub; do
    run "$built" --set "x_start=${x}mm" --set "m=$m" --set "rub=$rub" --tape "$scratch/tape"
    verdict $? "a table at $x mm, of $m kg, with $rub N*m, is where it should be"
    # the encoder has 1.25 um per count; the screw has a pitch of 5 mm
    "$whirl" pil --read "$scratch/tape" | awk -F, -v x="$x" '$5 == "theta" && $3 == "sample" { a = $6 }
        END { d = x + 5 * a / 6.28318530718 - 20; exit !(a != "" && d < 0.02 && d > -0.02) }'
    verdict $? "the plant says so, too"
done <"$scratch/drawn"

# Compares the plant's record with the samples that the firmware received, by the encoder and by the scene's own
# statement of x. The rows have the form of `whirl run`.
header='time,theta,der(theta),x'
for program in "$built" $elf; do
    every=$(awk -v seed="${WHIRL_SEED:-1}" 'BEGIN { srand(seed + 1); print 1 + int(9 * rand()) }')
    run "$program" --tape "$scratch/tape" --csv "$scratch/plant.csv" --every "${every}ms" &&
        "$whirl" pil --read "$scratch/tape" | awk -F, -v OFS=, '$3 == "sample" { print $1, $6 }' >"$scratch/heard" &&
        grep -qx "whirl = \"$("$whirl" --version | sed 's/.* //')\"" "$scratch/plant.csv.toml" &&
        tr -d '\r' <"$scratch/plant.csv" | awk -F, -v every="$every" -v header="$header" '
            FNR == NR { theta[sprintf("%.3f", $1)] = $2; next }
            FNR == 1 { if ($0 != header) bad = bad " header"; next }
            { n++; d = $1 - (n - 1) * every / 1000; if (d * d > 1e-18) bad = bad " " $1 }
            { d = $4 - (0.0123 + 0.005 / 6.283185307179586 * $2); if (d * d > 1e-20) bad = bad " x" }
            (sprintf("%.3f", $1) in theta) && FNR > 2 { same++; d = $2 - theta[sprintf("%.3f", $1)]; if (d * d > 0.0008 ^ 2) bad = bad " theta" $1 }
            END { print n, same bad; exit bad != "" || n < 300 || same < n - 2 }' "$scratch/heard" - >"$scratch/said"
    verdict $? "${program##*/}: the plant's rows, those with samples: $(cat "$scratch/said")" "$scratch/out"
done
# no row if none is requested; bad input is refused
refused() {
    ! run "$built" --csv "$scratch/x.csv" "$@" && grep -q "error: --every" "$scratch/err"
    verdict $? "refused: $*" "$scratch/err"
}
refused --every 0
refused --every 1.03ms
refused --every 2kg
! run "$built" --every 2ms && grep -q -e '--every needs --csv' "$scratch/err"
verdict $? "refused: --every without --csv" "$scratch/err"
run "$built" --csv - --until 10ms && [ "$(wc -l <"$scratch/out")" -eq 12 ] && grep -q 'command stream' "$scratch/err"
verdict $? "--csv - has standard output to itself" "$scratch/out"
cp "$scratch/table.whirl" "$scratch/kept"
! run "$built" --csv "$scratch/table.whirl" && cmp -s "$scratch/table.whirl" "$scratch/kept"
verdict $? "the scene is not written over" "$scratch/err"
[ ! -c /dev/full ] || { ! run "$built" --csv /dev/full && grep -q 'cannot be written' "$scratch/err"; }
verdict $? "a full disk is told" "$scratch/err"

# bug NAME STATUS PATTERN SED: with that change, the firmware ends with this status, and the run reports the reason
bug() {
    sed "$4" "$scratch/pil_table.c" >"$scratch/$1.c"
    ! cmp -s "$scratch/pil_table.c" "$scratch/$1.c" && build "${built##*/}" "$scratch/$1.c" "$scratch/$1"
    verdict $? "$1: builds"
    run "$scratch/$1"
    [ $? -eq "$2" ] && grep -q "$3" "$scratch/err"
    verdict $? "$1: status $2, $3" "$scratch/err"
}
bug no_number 1 "set 'u' to NaN at t = 0.1 s" 's/wanted - rate) + sum)/wanted - rate) + sum + (period < 100U ? 0.0f : rate * 0.0f \/ (rate * 0.0f)))/'
bug stands_still 1 'time does not advance after t = 0 s' 's/period \* PERIOD); .*/0U); period = 1U;/'
exit $failed
