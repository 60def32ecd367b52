#!/bin/sh
# work.sh TOP JOB MUTANTS TESTS NAME...: a job of mutants.sh. From each NAME.drawn it takes, in order, changes that no
# job has taken and that are not in NAME.found, until there are MUTANTS mutants. It builds and tests each in TOP/srcJOB,
# and appends a line to NAME.found:
#   number  refused | same | killed | survived  by what  TESTS
# refused: it does not compile. same: it gives the same objects, so it is no mutant. killed and survived: by which
# tests. TESTS names the state of the tests. The environment has the settings of mutants.sh.
set -u

here=$(cd "$(dirname "$0")" && pwd)
top=$(cd "$1" && pwd)
job=$2 mutants=$3 tests=$4
shift 4
base=$top/src tree=$top/src$job log=$top/log$job
tab=$(printf '\t')
# Old compilers only warn about types that do not fit. Such a change must not pass as compiled.
misfits='Wincompatible-pointer-types|Wint-conversion|Wimplicit-function-declaration'

unset MAKEFLAGS MFLAGS MAKELEVEL
cd "$tree" || exit 1

# --- one change -----------------------------------------------------------------------------------------
apply() { # apply FILE LINE COLUMN LENGTH REPLACEMENT
    touch .changed
    REPLACEMENT=$5 awk -v line="$2" -v column="$3" -v size="$4" 'NR == line {
        text = $0 " "
        $0 = substr(text, 1, column - 1) ENVIRON["REPLACEMENT"] substr(text, column + size)
        sub(/ +$/, "")
    } { print }' "$base/$1" >"$1"
}
put_back() { # restores the file, and what was built since
    cp -p "$base/$1" "$1"
    find build -type f -newer .changed >"$log.new"
    while read -r built; do
        if [ -e "$base/$built" ]; then cp -p "$base/$built" "$built"; else rm -f "$built"; fi
    done <"$log.new"
    rm -f .changed
}
# Compares two objects without the parts that only a debugger reads.
differ() { objcopy -g "$1" "$log.a" && objcopy -g "$base/$1" "$log.b" && ! cmp -s "$log.a" "$log.b"; }
any_differ() { # any_differ FILE...
    for built in "$@"; do ! differ "$built" || return 0; done
    return 1
}
# build PROGRAM...: the generated scenes stay those of the tree, because compiling them again for each change would
# take most of the time. Tests that read them are skipped if they are not what a user would have built (usable()).
build() {
    make -o build/gen/.stamp -o build/float/libscenes.a -o build/double/libscenes.a -o build/gen/models.list \
        "$@" >"$log.build" 2>&1 && ! grep -qE "$misfits" "$log.build"
}

# --- tests ----------------------------------------------------------------------------------------------
# reaching FILE LINE: prints the tests that reach the changed line.
reaching() {
    (cd "$top/reach" && grep -s -H "^$1 " counted *.lines) |
        awk -v file="$1" -v line="$2" -f "$here/reaching.awk" "$base/$1" -
}
# order FOUND REACHING: prints the tests in order. Quick tests come first, and those that have killed mutants, mostly of
# this row.
order() {
    awk -F '\t' -v own="$1" -v longest="$LONGEST" -v always="$ALWAYS" -v never="$NEVER" '
        FILENAME == ARGV[1] { reaches[$1]; next }
        FILENAME ~ /\.found$/ {
            if ($2 == "killed") { sub(/ \(.*/, "", $3); kills[$3] += FILENAME == own ? 1 : 0.1 }
            next
        }
        {
            split($0, t, " ")
            test = t[2] "." t[3]
            gsub("/", "_", test)
            if (t[2] ~ /^(host|cli)$/ && !("all" in reaches) && !(test in reaches)) next
            if ((t[1] <= longest || (always != "" && t[3] ~ always)) && t[3] !~ never)
                print -(kills[t[2] " " t[3]] + 0.1) / (t[1] + 0.03), t[1], t[2], t[3]
        }' "$2" "$top"/*.found "$top/times" | sort -n | cut -d ' ' -f 2-
}
# usable KIND SUITE: returns false for a suite of a program in which nothing changed, and for a suite of generated
# scenes if their generator, or a file that they include, has changed.
usable() {
    case $1 in
    cli) differ build/whirl ;;
    host) differ build/tests/host ;;
    *) { [ "$2" != scenes ] || [ "${file%.c}" != "$file" ]; } && differ "build/tests/core_$1" ;;
    esac
}
# run SECONDS KIND NAME: runs a test, with a limit of six times its processor time plus five seconds.
run() {
    limit=$(awk -v s="$1" 'BEGIN { print int(6 * s + 5) }')
    case $2 in
    cli) set -- sh "$3" ;;
    host) set -- build/tests/host "$3" ;;
    *) set -- "build/tests/core_$2" "$3" ;;
    esac
    { (ulimit -t "$limit" && ulimit -v 4000000 && ulimit -c 0 &&
        WHIRL=build/whirl exec timeout --kill-after=5 $((limit * SLACK + 60)) "$@") </dev/null; } >"$log.test" 2>&1
}
judge() { # judge NAME STAGE: runs the tests that the stage's programs allow, and writes the result to `came`
    order "$1.found" "$log.reaching" >"$log.order"
    checked=""
    while read -r took program suite; do
        [ "$program" = "$2" ] || [ "$program.$2" = cli.host ] || continue
        case " $checked " in
        *" $program:no "*) continue ;;
        *" $program:yes "*) [ "$suite" != scenes ] || usable "$program" "$suite" || continue ;;
        *)
            if ! usable "$program" "$suite"; then
                [ "$suite" = scenes ] || checked="$checked $program:no"
                continue
            fi
            checked="$checked $program:yes"
            ;;
        esac
        spent=$(awk -v spent="$spent" -v took="$took" 'BEGIN { print spent + took }')
        if [ "${spent%.*}" -ge "$PATIENCE" ]; then
            came="survived${tab}others were not asked"
            return
        fi
        asked=$((asked + 1))
        run "$took" "$program" "$suite"
        case $? in
        0) continue ;;
        124 | 137 | 152) how=" (no end)" ;;
        13[0-9]) how=" (crash)" ;;
        *) how="" ;;
        esac
        came="killed$tab$program $suite$how"
        return
    done <"$log.order"
    came="survived${tab}$asked asked"
}
try() { # try NAME NUMBER FILE LINE COLUMN LENGTH REPLACEMENT
    file=$3
    apply "$3" "$4" "$5" "$6" "$7"
    stages="host"
    case $3 in core/*) stages="double host float" ;; esac
    came="same$tab-"
    asked=0
    spent=0
    reaching "$3" "$4" >"$log.reaching"
    for stage in $stages; do # one stage after the other is built and tested
        case $stage in
        host) programs="build/whirl build/tests/host" ;;
        *) programs="build/tests/core_$stage" ;;
        esac
        if ! build $programs; then
            came="refused$tab-"
        elif any_differ $(find build -name '*.o' -newer .changed); then
            judge "$1" "$stage"
        fi
        case $came in refused* | killed*) break ;; esac
    done
    printf '%s\t%s\t%s\n' "$2" "$came" "$tests" >>"$1.found"
    put_back "$3"
    tried=$(mutants_of "$1")
    case $came in [ks]*ed*) [ $((tried % 10)) -ne 0 ] || echo "  ${1##*/}: $tried of $mutants" ;; esac
}

# --- all of them ------------------------------------------------------------------------------------------
mutants_of() { grep -c -E "^[0-9]+$tab(killed|survived)" "$1.found"; }
: >"$log.reaching"
for relative in "$@"; do
    name=$top/${relative##*/}
    while IFS="$tab" read -r number file line column size replacement kind; do
        [ -n "$kind" ] || replacement="" # because the shell takes two tabs for one
        ! grep -q "^$number$tab" "$name.found" || continue
        [ "$(mutants_of "$name")" -lt "$mutants" ] || break
        mkdir "$name.claims/$number" 2>/dev/null || continue
        try "$name" "$number" "$file" "$line" "$column" "$size" "$replacement"
    done <"$name.drawn"
done
