#!/bin/sh
# flags.sh [fast|quick]: the flag matrix. Scenes and core are compiled with other people's flags, in float and double,
# by every installed compiler. The result must be the interpreter's bits or a refusal, by the compiler (#error) or by
# wh_scene_start(). If flags do not affect the arithmetic, or pragmas can restore it, a refusal fails, too. The board's
# images run in its emulator.
#
# `quick` takes three sets of flags, those with two stars, and one scene: seconds. `fast`, for `make test`, takes the
# sets with a star, in float; with WHIRL_FULL=1 also in double, with WHIRL_FULL=rest only in double. `make flags` takes
# all.
. "$(dirname "$0")/checks.sh"

part=${1:-all}
bits=0
refusals=0
wrong=0

# --- the flags: MUST is `same`, `either` (the same bits or a refusal), or `refuse` (guards are gone) ----------------------------------------------
# A star marks the sets of `fast`. Flags after "link:" are for the linker only.
cat >"$scratch/gcc" <<'END'
same -std=c11 -O0
same -std=c11 -O2
same -std=c11 -O3
same* -std=gnu11 -Og
same -std=gnu11 -O0
same -std=gnu11 -O2
same -std=gnu17 -O3
same -std=gnu17 -Os
same -std=gnu11 -O2 -march=haswell
same -std=gnu17 -O3 -march=haswell
same -std=gnu11 -Os -march=haswell
same -std=c11 -O2 -march=haswell -ffp-contract=fast
same* -std=gnu11 -O3 -march=haswell -ffp-contract=fast
same -std=gnu11 -O2 -march=haswell -flto
same -std=gnu11 -O2 -fno-math-errno
same -std=gnu11 -O2 -fno-trapping-math
same* -std=gnu11 -O2 -frounding-math
same** -std=gnu11 -O0 -frounding-math
either** -std=gnu11 -O0 -ffast-math
same -std=gnu11 -O2 -m32 -msse2 -mfpmath=sse
either* -std=gnu11 -O2 -ffast-math
either -std=gnu11 -Ofast
either* -std=gnu11 -O2 -funsafe-math-optimizations
either -std=gnu11 -O2 -fassociative-math -fno-signed-zeros -fno-trapping-math
either -std=gnu11 -O2 -freciprocal-math
either -std=gnu11 -O2 -ffinite-math-only
either -std=gnu11 -O2 -fno-signed-zeros
either* -std=gnu11 -O2 -mfpmath=387
either -std=c11 -O2 -mfpmath=387
either -std=gnu11 -O2 -m32
either -std=gnu11 -O2 -m32 -mfpmath=387
either -std=gnu11 -O2 -m32 -msse2 -mfpmath=both
either -std=gnu11 -O2 -fsingle-precision-constant
either* -std=gnu11 -O2 link: -ffast-math
END
cat >"$scratch/clang" <<'END'
same** -std=c11 -O0
same -std=c11 -O2
same -std=gnu11 -O2
same -std=gnu17 -O3
same -std=gnu17 -Os
same* -std=gnu11 -O2 -march=haswell
same -std=gnu17 -O3 -march=haswell
same -std=gnu11 -O2 -march=haswell -ffp-contract=on
either* -std=gnu11 -O2 -march=haswell -ffp-contract=fast
either -std=gnu11 -O2 -ffast-math
either -std=gnu11 -Ofast
either* -std=gnu11 -O2 -funsafe-math-optimizations
either -std=gnu11 -O2 -fassociative-math -fno-signed-zeros -fno-trapping-math
either -std=gnu11 -O2 -freciprocal-math
either -std=gnu11 -O2 -ffinite-math-only
either -std=gnu11 -O2 -fno-signed-zeros
refuse* -std=gnu11 -O2 -fno-honor-nans
either -std=gnu11 -O2 -m32 -march=i686
END
cat >"$scratch/arm-none-eabi-gcc" <<'END'
same -std=c11 -O0
same -std=c11 -O2
same -std=gnu11 -Og
same* -std=gnu11 -O2
same -std=gnu17 -O3
same -std=gnu11 -Os
same -std=gnu11 -O2 -fno-math-errno
same -std=c11 -O2 -ffp-contract=fast
same -std=gnu11 -O3 -ffp-contract=fast
either -std=gnu11 -O2 -ffast-math
either -std=gnu11 -Ofast
either -std=gnu11 -O2 -funsafe-math-optimizations
either -std=gnu11 -O2 -fassociative-math -fno-signed-zeros -fno-trapping-math
either -std=gnu11 -O2 -freciprocal-math
either -std=gnu11 -O2 -ffinite-math-only
END

# --- the scenes: plain, compensated, a contact, roots and quotients --------------------------------------------------------
mkdir -p "$scratch/build/gen"
cat >"$scratch/roots.whirl" <<'END'
mechanism roots "square roots, quotients, powers"
coordinate x [m]
coordinate y [m]
parameter m = 2 [kg]
parameter k = 8 [N/m]
let s = sqrt(x^2 + y^2 + 0.01 [m^2])
T = m*(x'^2 + y'^2)/2 + m*y^2*x'^2/(3*s^2)
V = k*(s - 1 [m])^2/2 + k*s^1.5*1 [m^(1/2)]/9 + 1 [J*m]/s
F = 0.2 [kg/m]*abs(y' - x')^3/3
scene roots_swing { start x = 0.7 [m], y = -0.4 [m], x' = 0.3 [m/s]; step 1 [ms]; until 1 [s] }
END
cat >"$scratch/list" <<END
thomson_a --until 0.5s
epicyclic_from_rest --until 1s --compensated
ball_bounces --until 0.6s
$scratch/roots.whirl:roots_swing
END
[ "$part" != quick ] || sed -i '2,$d' "$scratch/list"
while read -r what; do
    set -- $what
    scene=${1##*:}
    "$whirl" derive "$@" --as c --header "$scratch/build/gen/$scene.h" >"$scratch/build/gen/$scene.c" || exit 1
    echo "$scene" >>"$scratch/scenes"
    for real in float double; do
        "$whirl" run "$@" --number $real 2>&1 |
            sed -n "s/^state hash  */scene $scene hash /p" >>"$scratch/wanted.$real"
    done
done <"$scratch/list"
mk/count/index.sh $(cat "$scratch/scenes") >"$scratch/build/gen/scenes.c"
wanted_count=$(wc -l <"$scratch/scenes")

# --- one build -------------------------------------------------------------------------------------------------------------
can_fuse=$(grep -c -m 1 -w fma /proc/cpuinfo 2>/dev/null)
# The emulator's programs end by themselves and use no line, so the files of flashed images and of lines are omitted.
demo_sources=$(ls boards/cortexm/*.c boards/shared/*.c | grep -vE '/(flashed|kept|link|link_console|remembered|reset_words|rig_time)\.c$')
board=boards/mps2-an386
emulate="sh tests/limit.sh 60 qemu-system-arm -M mps2-an386 -nographic -semihosting-config enable=on,target=native -kernel"
board_flags="-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard -ffreestanding -I$board"

compile() { # compile COMPILER REAL FLAGS...: $scratch/program, with what was said in $scratch/said
    by=$1
    double=0
    [ "$2" = float ] || double=1
    shift 2
    all=$*
    own=${all%%link:*}
    link=${all##*link:}
    rm -f "$scratch/program"
    set -- -I"$scratch" -I. -DWH_DOUBLE=$double
    if [ "$by" = arm-none-eabi-gcc ]; then
        $by $own $board_flags "$@" -nostdlib -T$board/board.ld -L. -o "$scratch/program" \
            "$scratch"/build/gen/*.c core/*.c boards/programs/scenes.c $demo_sources -lgcc
    elif [ "$link" = "$all" ]; then
        $by $own "$@" -o "$scratch/program" "$scratch"/build/gen/*.c core/*.c \
            boards/programs/scenes.c boards/host/board.c
    else
        mkdir -p "$scratch/objects" && rm -f "$scratch"/objects/*
        for file in "$scratch"/build/gen/*.c core/*.c boards/programs/scenes.c boards/host/board.c; do
            $by $own "$@" -c -o "$scratch/objects/$(echo "$file" | tr '/' '_').o" "$file" || return 1
        done
        $by $link -o "$scratch/program" "$scratch"/objects/*.o
    fi >"$scratch/said" 2>&1
}

run() { # run COMPILER: its lines, without what only some consoles add
    if [ "$1" = arm-none-eabi-gcc ]; then
        $emulate "$scratch/program" </dev/null 2>/dev/null
    else
        sh tests/limit.sh 60 "$scratch/program" </dev/null 2>/dev/null
    fi | tr -d '\r' | grep '^scene ' | sed 's/ steps [0-9]*//; s/ ok$//'
}

# how the build came out, in $outcome
try() { # try COMPILER REAL FLAGS...
    outcome="OTHER BITS"
    if ! compile "$@"; then
        outcome="DOES NOT COMPILE"
        grep -q '#error "Whirl' "$scratch/said" || grep -q 'error: "\?Whirl' "$scratch/said" || return
        outcome="refused by the compiler"
        return
    fi
    case "$*" in
    *haswell*)
        if [ "${can_fuse:-0}" -eq 0 ]; then # this machine cannot run it: what would it execute?
            fused=$(objdump -d "$scratch/program" | grep -c -E 'vfn?m(add|sub)')
            [ "$fused" -ne 0 ] || outcome="no fused operation (not run: no FMA here)"
            return
        fi ;;
    esac
    run "$1" >"$scratch/got"
    if cmp -s "$scratch/wanted.$2" "$scratch/got"; then
        outcome="same bits"
    elif [ "$(grep -c 'the arithmetic is not that of IEEE 754' "$scratch/got")" -eq "$wanted_count" ]; then
        outcome="refused at the start"
    fi
}

# --- the matrix ------------------------------------------------------------------------------------------------------------
echo "| compiler | flags | float | double |"
echo "|---|---|---|---|"
for compiler in gcc clang arm-none-eabi-gcc; do
    if ! command -v "$compiler" >/dev/null 2>&1; then
        echo "| $compiler | is not here | | |"
        continue
    fi
    reals="float double"
    [ "$compiler" != arm-none-eabi-gcc ] || reals=float
    case "$part ${WHIRL_FULL:-}" in
    "fast " | quick*) reals=float ;;
    "fast rest") [ "$reals" != float ] || continue && reals=double ;;
    esac
    while read -r must flags; do
        [ "$part" != fast ] || [ "$must" != "${must%\*}" ] || continue
        [ "$part" != quick ] || [ "$must" != "${must%\*\*}" ] || continue
        must=${must%%\**}
        case " $flags " in
        *" -m32 "*)
            echo 'int main(void) { return 0; }' >"$scratch/empty.c"
            "$compiler" -m32 -o "$scratch/empty" "$scratch/empty.c" 2>/dev/null || {
                echo "| $compiler | \`$flags\` | no 32-bit library here | |"
                continue
            } ;;
        esac
        row="| $compiler | \`$flags\` |"
        for real in $reals; do
            try "$compiler" $real $flags
            row="$row $outcome |"
            good=1
            case "$outcome" in
            same\ bits | no\ fused*) bits=$((bits + 1)) && { [ "$must" = refuse ] || good=0; } ;;
            refused*) refusals=$((refusals + 1)) && { [ "$must" = same ] || good=0; } ;;
            esac
            [ $good -eq 0 ] || {
                wrong=$((wrong + 1))
                [ "$outcome" != "OTHER BITS" ] || diff "$scratch/wanted.$real" "$scratch/got" >"$scratch/said"
                verdict 1 "$compiler $flags, $real: $outcome" "$scratch/said"
            }
        done
        [ "$reals" != float ] || row="$row not built |"
        echo "$row"
    done <"$scratch/$compiler"
done
echo
[ "$failed" -eq 0 ] && [ $((bits + refusals)) -ge "$([ "$part" = quick ] && echo 2 || echo 7)" ] # what gcc and the board's compiler alone make in `fast`
verdict $? "$bits builds give the interpreter's bits, $refusals are refused, $wrong are not as they must be" /dev/null
exit $failed
