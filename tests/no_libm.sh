#!/bin/sh
# no_libm.sh PROGRAM...: no program uses a function of the mathematical library, whichever system file contains it, because
# results must not depend on the machine's library.
set -eu

names='(a?(sin|cos|tan)h?|sincos|atan2|(sin|cos|tan)pi|exp(2|10|m1)?|log(2|10|1p|b)?|pow|sqrt|cbrt|hypot|erfc?|[lt]gamma|j[01n]|y[01n]'
names="$names|fmod|remainder|remquo|drem|floor|ceil|trunc|l?l?round|l?l?rint|roundeven|nearbyint|modf|frexp|ldexp|scalbl?n|ilogb"
names="$names|fm(ax|in|a)|fdim|fabs|copysign|next(after|toward)|nan)[fl]?"

[ "$#" -gt 0 ] || { echo "no_libm.sh: no program given" >&2; exit 1; }
bad=0
for program in "$@"; do
    # First the check must see a symbol that every program has.
    taken=$(nm -u "$program" | sed 's/.* //; s/@.*//; s/^__\(.*\)_finite$/\1/')
    echo "$taken" | grep -q 'libc_start_main\|fprintf\|malloc' ||
        { echo "error: nm shows nothing of $program" >&2; exit 1; }
    found=$(echo "$taken" | grep -xE "$names" | tr '\n' ' ')
    if [ -n "$found" ]; then
        echo "error: $program takes from a library: $found"
        bad=1
    fi
done
exit $bad
