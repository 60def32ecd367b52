#!/bin/sh
# no_libm.sh: the program uses no function of the mathematical library. `make gate-libm` checks unoptimised programs.
. "$(dirname "$0")/../checks.sh"

check "no function of libm" sh tests/no_libm.sh "$whirl"

# The check must find such a function, in libm or in another library.
for function in exp frexp; do
    cat >"$scratch/probe.c" <<END
#include <math.h>
#include <stdio.h>
int main(int count, char **words) {
    int ignored = count + (words != 0);
    double (*volatile of)() = (double (*)())$function;
    printf("%g %d\n", ((double (*)(double, int *))of)(2.5, &ignored), ignored);
    return 0;
}
END
    "${CC:-cc}" -w -O0 -o "$scratch/probe" "$scratch/probe.c" -lm 2>"$scratch/err"
    verdict $? "a program with $function()"
    sh tests/no_libm.sh "$scratch/probe" >"$scratch/err" 2>&1
    [ $? -eq 1 ] && grep -q " $function " "$scratch/err"
    verdict $? "is found out"
done

# On a board without a square-root instruction, a scene with roots and functions uses only the compiler's support code.
cat >"$scratch/roots.whirl" <<'END'
mechanism roots
coordinate x [m]
coordinate y [m]
let s = sqrt(x^2 + y^2 + 0.01 [m^2])
T = 2 [kg]*(x'^2 + y'^2)/2
V = 4 [N/m]*(s - 1 [m])^2 + 1 [J]*exp(x/(9 [m]))
output o [rad] = atan2(x, y) + ((y/(1 [m]))^2 + 1)^1.37*1 [rad]
END
"$whirl" derive "$scratch/roots.whirl" --as c >"$scratch/roots.c" 2>"$scratch/err"
verdict $? "a scene with roots"
if command -v arm-none-eabi-gcc >/dev/null 2>&1; then
    for flags in "-mcpu=cortex-m0 -O2 -ffreestanding" "-mcpu=cortex-m3 -O0" "-mcpu=cortex-m3 -Os -DWH_DOUBLE=1" \
        ${WHIRL_FULL:+"-mcpu=cortex-m4 -mfpu=fpv4-sp-d16 -mfloat-abi=hard -O0"}; do
        arm-none-eabi-gcc $flags -mthumb -std=c11 -ffp-contract=off -I. -nostdlib -r -o "$scratch/all.o" \
            "$scratch/roots.c" core/*.c 2>"$scratch/err"
        verdict $? "compiled with $flags"
        arm-none-eabi-nm "$scratch/all.o" | grep -q ' T wh_scene_start' &&
            ! arm-none-eabi-nm -u "$scratch/all.o" | grep -vE ' (__aeabi_|__gnu_thumb1|__clz|__ctz|memcpy|memset)' >"$scratch/err"
        verdict $? "and only compiler's support is missing"
    done
fi
exit $failed
