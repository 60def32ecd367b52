#!/bin/sh
# check_image.sh ELF...: fails if a firmware image contains forbidden code: a heap, the C library's mathematics or printing,
# or double-precision arithmetic in software. NM names the nm to use; the default is arm-none-eabi-nm. FLASHED lists the
# flashed images among them: they must contain no breakpoint, which without a debugger is a fault, and no way out of main().
# OBJDUMP shows their code. UNDRIVEN lists the images that must not be able to enable the motor: they must not call the
# function that does.
set -u
NM=${NM:-arm-none-eabi-nm}
OBJDUMP=${OBJDUMP:-arm-none-eabi-objdump}
FLASHED=${FLASHED:-}
UNDRIVEN=${UNDRIVEN:-}

if [ $# -eq 0 ]; then
    echo "usage: $0 ELF..." >&2
    exit 2
fi

failed=0
# only_flashed ELF: report code that a flashed image must not contain.
only_flashed() {
    if ! code=$("$OBJDUMP" -d "$1"); then
        return 1
    fi
    printf '%s\n' "$code" | awk -v elf="$1" '
        /^[0-9a-f]+ <.*>:$/ { where = $2; main_seen += where == "<main>:" }
        /\tbkpt/ { print elf ": a breakpoint in " where; bad = 1 }
        where == "<main>:" && /\t(ret$|bx\tlr|(pop|ldmia).*pc\}|ldr.*\tpc, \[sp)/ { print elf ": main() returns"; bad = 1 }
        END {
            if (main_seen != 1) { print elf ": has no main()"; bad = 1 }
            exit bad
        }'
}

for elf in "$@"; do
    case " $FLASHED " in
    *" $elf "*) only_flashed "$elf" || failed=1 ;;
    esac
    if ! symbols=$("$NM" "$elf"); then
        exit 2
    fi
    undriven=0
    case " $UNDRIVEN " in *" $elf "*) undriven=1 ;; esac
    printf '%s\n' "$symbols" | awk -v elf="$elf" -v undriven=$undriven '
        # Symbol names are the last field; undefined symbols have no address before their letter.
        function found(kind) {
            printf "%s: %s: %s%s\n", elf, kind, name, undefined ? " (undefined)" : ""
            bad++
        }
        NF >= 2 {
            name = $NF
            undefined = NF == 2
            known += !undefined
            bare = name
            sub(/^_+(ieee754_|kernel_|math_)?/, "", bare)
            sub(/_r$/, "", bare)
            if (undriven && name ~ /^hal_motor_(start|set_voltage)$/) {
                found("it can drive the motor")
            }
            if (bare ~ /^(m|c|re|mem|posix_mem)?al(loc|ign)$|^(free|cfree|sbrk|brk)$/) {
                found("heap")
            } else if (bare ~ /^(sin|cos|sincos|tan|asin|acos|atan|atan2|sinh|cosh|tanh|sqrt|cbrt|hypot|exp|exp2|expm1|log|log2|log10|log1p|pow|fmod|floor|ceil|round|lround|rint|trunc|fabs|ldexp|frexp|remainder|rem_pio2)[fl]?$/) {
                found("libm")
            } else if (bare ~ /^v?(f|s|sn|d|as|i|si|sni|fi)?printf$|^(v?s?n?printf_[a-z]+|puts|fputs|putchar|fwrite|scanf|sscanf|dtoa|svfprintf|svfiprintf|vfprintf|vfiprintf)$/) {
                found("printing")
            } else if (name ~ /^__aeabi_(d|cd|f2d|h2d|i2d|ui2d|l2d|ul2d)/ ||
                       name ~ /^__[a-z]+df([23]|[sdh]i|[sh]f2?)?$/ ||
                       name ~ /^__(extend|float|floatun|fix|fixuns|trunc)[a-z]*df[a-z]*2?$/ ||
                       name ~ /^__[a-z]*(tf|xf)[23]$/) {
                found("double in software")
            } else if (undefined && $1 == "U") {
                found("unresolved")
            }
        }
        END {
            if (known == 0) {
                printf "%s: no symbols: nothing can be said about this image\n", elf
                exit 1
            }
            if (bad) {
                exit 1
            }
            printf "%s: %d symbols, no heap, no libm, no printf, no double\n", elf, known
        }' || failed=1
done
exit $failed
