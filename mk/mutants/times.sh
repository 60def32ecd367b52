#!/bin/sh
# times.sh TREE KNOWN: prints the time of each suite and script in a built tree, the quickest first, in lines of
#   seconds of a processor, "host", "float", "double" or "cli", its name, a sum of its files
# Each test is run and must pass: a test that fails on the unchanged tree would kill every mutant. A test whose sum is
# in KNOWN, a file of such lines, is not run again, unless it was cut off there and would not be now. Tests that match
# NEVER are not run. A suite that is too long to be used is cut off, with the time so far. Scripts that do not depend on
# the changed folders, or that need other compilers, are omitted.
#
# Suites of "host" and scripts run in TREE/../reaching, whose programs record the lines that they reach (reach.c), in
# TREE/../reach/KIND.NAME.lines. JOBS tests run at the same time, each by a times.sh TREE KNOWN KIND NAME.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
known=$2
cd "$1"
top=$(dirname "$PWD")
: "${JOBS:=1}"
export WHIRL=build/whirl

sum_of() { cat "$@" | cksum | tr -d ' '; }

used() { # used LIMIT WALL COMMAND...: prints the processor seconds of the command and its children, and its exit status
    sh -c 'limit=$1 wall=$2; shift 2; (ulimit -t $limit && ulimit -c 0 && exec timeout --kill-after=5 $wall "$@") >/dev/null 2>&1 </dev/null; status=$?; times; echo $status' sh "$@" |
        awk 'NR == 2 { split($1, user, /[ms]/); split($2, sys, /[ms]/) }
             NR == 3 { print user[1] * 60 + user[2] + sys[1] * 60 + sys[2], $1 }'
}
lines_of() { # lines_of FOLDER: writes the lines in the programs' maps there to FOLDER.lines
    blocks=""
    for of in whirl host; do
        [ ! -e "$1/$of.map" ] || cmp -l "$1/$of.map" /dev/zero >"$1/$of" 2>/dev/null || true
        [ ! -s "$1/$of" ] || blocks="$blocks $top/reach/$of.blocks $1/$of"
    done
    if [ -n "$blocks" ]; then awk -f "$here/lines.awk" $blocks; fi >"$1.lines"
    rm -rf "$1"
}
told() { # told KIND NAME KEY PROGRAM...: prints the line of a test; if it fails, its name goes to .failed
    kind=$1 name=$2 key=$3
    shift 3
    line=$(grep -E "^[0-9.]+ $kind $name $key" "$known" | tail -n 1 || true)
    reached=""
    case $kind in host | cli) reached=$top/reach/$(echo "$kind.$name" | tr / _) ;; esac
    always=$(printf '%s\n' "$name" | grep -E "${ALWAYS:-^$}" || true)
    if [ -n "$line" ] && { [ -z "$reached" ] || [ -e "$reached.lines" ]; } && ! awk -v line="$line" -v longest="$LONGEST" \
        -v always="$always" 'BEGIN { split(line, t, " "); exit !(t[5] == "cut" && (t[1] < longest || always != "")) }'; then
        echo "$line"
        return
    fi
    limit=unlimited
    wall=$((360 * SLACK))
    if [ "$1" != sh ] && [ -z "$always" ]; then
        limit=$((${LONGEST%.*} + 2))
        wall=$((limit * SLACK + 60)) # wall-clock limit, for programs that the test starts
    fi
    if [ -z "$reached" ]; then
        took=$(used "$limit" "$wall" "$@")
    else
        rm -rf "$reached"
        mkdir -p "$reached"
        took=$(cd "$top/reaching" && REACH_FOLDER=$reached used "$limit" "$wall" "$@")
        lines_of "$reached"
    fi
    line="${took% *} $kind $name $key"
    case ${took#* }$limit in
    0*) ;;
    *unlimited) echo "$kind $name" >>.failed && return ;;
    124* | 137* | 152*) line="$line cut" ;;
    *) echo "$kind $name" >>.failed && return ;;
    esac
    echo "$line" | tee -a "$known" # for who breaks this off
}

if [ $# -gt 2 ]; then
    case $3 in
    cli) told cli "$4" "$common.$pages.$(sum_of "$4")" sh "$4" ;;
    host) told host "$4" "$common.$(sum_of "$(grep -lE "^(void suite_|SUITE\(|TEST\()$4[(,)]" tests/host/test_*.c)")" build/tests/host "$4" ;;
    *) told "$3" "$4" "$common.$(sum_of "$(grep -lE "^(void suite_|SUITE\(|TEST\()$4[(,)]" tests/core/test_*.c)")" "build/tests/core_$3" "$4" ;;
    esac
    exit 0
fi

# Files that belong to a single suite or script are not in the sum of the others.
common=$(sum_of Makefile $(find core hal boards host tests -type f ! -path 'tests/*/test_*' ! -path 'tests/cli/*.sh' | sort))
pages=$(sum_of $(find docs -type f ! -name testing.md ! -name mutants.md | sort))
export common pages JOBS
rm -f .failed
{
    for build in host float double; do
        list=build/tests/core_suites.c
        [ "$build" != host ] || list=build/tests/host_suites.c
        sed -n "s/^void suite_\([a-z0-9_]*\)(void);/$build \1/p" "$list"
    done
    ls tests/cli/*.sh | sed 's/^/cli /' |
        grep -vE '/(embed_.*|emitted_c|effects_cost_nothing|flags|interrupt|no_libm|suites|worst_step_marks)\.sh$'
} | awk -v never="${NEVER:-^$}" '$2 !~ never' | xargs -P "$JOBS" -n 2 sh "$here/times.sh" "$PWD" "$known" | sort -n
if [ -e .failed ]; then
    echo "make mutants: these fail on the tree as it is:" $(cat .failed) >&2
    exit 1
fi
