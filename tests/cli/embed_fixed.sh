#!/bin/sh
# embed_fixed.sh: the fixed-point program of docs/embedding.md, built as its commands there say and by each installed
# compiler, in C and C++, has the interpreter's bits. On boards its step calls no floating-point function.
. "$(dirname "$0")/../checks.sh"

mkdir "$scratch/hand" "$scratch/hand/build"
ln -s "$PWD/core" "$scratch/hand/core"
ln -s "$(realpath "$whirl")" "$scratch/hand/build/whirl"
awk -v into="$scratch/hand" '
    /^## / { here = $0 == "## In fixed point" }
    /^```whirl$/ && here { file = into "/arm.whirl"; next }
    /^```c$/ && here { file = into "/main.c"; next }
    /^```sh$/ && here { file = into "/commands"; next }
    /^```/ { file = "" }
    file != "" { print > file }' docs/embedding.md
(cd "$scratch/hand" && sh -e commands) >"$scratch/said" 2>"$scratch/err"
verdict $? "the commands of docs/embedding.md build and run it"
[ "$(sed -n 's/^state hash *//p' "$scratch/said" | sort -u | wc -l)" -eq 1 ] &&
    [ "$(grep -c '^state hash *0x' "$scratch/said")" -eq 2 ]
verdict $? "the program ends in the interpreter's bits" "$scratch/said"
wanted=$(grep "^state hash 0x" "$scratch/said")
# the motion's end, by the interpreter in double
"$whirl" run "$scratch/hand/arm.whirl:arm_swings" --set M=0.375 --csv - --quiet 2>/dev/null | tr -d '\r' | tail -n 1 >"$scratch/row"
awk -F'[ ,]' 'FNR == NR && / rad\/s, / { rate = $(NF - 1) } FNR == NR && NF == 2 && / rad$/ { angle = $1 }
    FNR != NR { end[1] = $2; end[2] = $3 }
    END { exit !(angle != "" && (angle - end[1])^2 < 1e-11 && (rate - end[2])^2 < 1e-9) }' "$scratch/said" "$scratch/row"
verdict $? "angle and rate are those of the run in double" "$scratch/said"

warnings="-Wall -Wextra -Wconversion -Wshadow -Werror"
for compiler in "gcc -std=c11 -Os" "clang -std=c11 -O2" "gcc -std=gnu11 -O0" "clang -std=gnu11 -O1 -DWH_FIXED_NARROW=1"; do
    command -v "${compiler%% *}" >/dev/null 2>&1 || continue
    (cd "$scratch/hand" && $compiler $warnings -I. -o strict main.c arm_swings.c core/fixed.c core/fixed_scene.c && ./strict) \
        >"$scratch/strict" 2>"$scratch/err" && grep -qxF "$wanted" "$scratch/strict"
    verdict $? "$compiler: without a warning, the same bits"
done
for compiler in "g++ gcc" "clang++ clang"; do
    command -v "${compiler%% *}" >/dev/null 2>&1 || continue
    (cd "$scratch/hand" && ${compiler% *} -std=c++11 $warnings -I. -x c++ -c main.c -o main.o &&
        for file in arm_swings.c core/fixed.c core/fixed_scene.c; do ${compiler#* } -std=c11 -O1 -I. -c $file || exit 1; done &&
        ${compiler% *} -o plus main.o arm_swings.o fixed.o fixed_scene.o && ./plus) >"$scratch/plus" 2>"$scratch/err" &&
        grep -qxF "$wanted" "$scratch/plus"
    verdict $? "${compiler% *}: the program as C++11, the same bits"
done

for board in "arm-none-eabi-gcc -mcpu=cortex-m0 -mthumb" "arm-none-eabi-gcc -mcpu=cortex-m3 -mthumb" "avr-gcc -mmcu=atmega328p"; do
    command -v "${board%% *}" >/dev/null 2>&1 || continue
    (cd "$scratch/hand" && $board -std=c11 -Os -Wall -Wextra -Werror -I. -c arm_swings.c -o board.o) 2>"$scratch/err" &&
        "$(echo "${board%% *}" | sed 's/gcc$/nm/')" "$scratch/hand/board.o" >"$scratch/names" &&
        ! grep -E ' U (__aeabi_[fdl]|__(add|sub|mul|div|float|fix)[a-z]*[sd]f)' "$scratch/names" >"$scratch/err" &&
        grep -q arm_swings "$scratch/names"
    verdict $? "$board: integers only"
done
exit $failed
