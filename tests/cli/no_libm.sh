#!/bin/sh
# no_libm.sh: the program takes no function of the mathematical library. `make gate-libm` looks at unoptimised ones.
. "$(dirname "$0")/../checks.sh"

check "no function of libm" sh tests/no_libm.sh "$whirl"

# The check must see one that is there, and one that other libraries hold.
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
exit $failed
