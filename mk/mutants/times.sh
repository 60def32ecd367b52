#!/bin/sh
# times.sh TREE KNOWN: what each suite and each script takes in a built tree, quickest first:
#   seconds of a processor, "host", "float", "double", "cli" or "last", its name, a sum of what it is made of
# Each is run, and must pass: what fails on the tree as it is would kill every change. What KNOWN, a file of such
# lines, has of the same sum is not run again, unless it was cut off and would not be now; what NEVER matches is not run at
# all. A suite that will not be asked for its length is not run to its end: what it had taken by then stands for its time.
# Scripts that say nothing about the folders that are changed, or that need other compilers, are left out.
#
# Suites and scripts of the kinds in REACH are run in TREE/../reaching, whose programs mark what they reach (reach.c):
# TREE/../reach/KIND.NAME.lines gets the lines. JOBS tests are run at the same time, each by a times.sh TREE KNOWN KIND NAME.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
known=$2
cd "$1"
top=$(dirname "$PWD")
: "${REACH:=}" "${JOBS:=1}"
export WHIRL=build/whirl

sum_of() { cat "$@" | cksum | tr -d ' '; }
key() { # key KIND NAME
    case $1 in
    cli) echo "$common.$pages.$(sum_of "$2")" ;;
    host) echo "$common.$(sum_of "$(grep -lE "^(void suite_|TEST\()$2[(,]" tests/host/test_*.c)")" ;;
    float | double) echo "$common.$(sum_of "tests/core/test_$2.c")" ;;
    *) echo "$common" ;;
    esac
}

used() { # used LIMIT WALL COMMAND...: seconds of a processor, of it and its children, and the exit status
    sh -c 'limit=$1 wall=$2; shift 2; (ulimit -t $limit && ulimit -c 0 && exec timeout --kill-after=5 $wall "$@") >/dev/null 2>&1 </dev/null; status=$?; times; echo $status' sh "$@" |
        awk 'NR == 2 { split($1, user, /[ms]/); split($2, sys, /[ms]/) }
             NR == 3 { print user[1] * 60 + user[2] + sys[1] * 60 + sys[2], $1 }'
}

lines_of() { # lines_of FOLDER: what the programs' maps there say, as FOLDER.lines
    blocks=""
    for of in whirl host; do
        [ ! -e "$1/$of.map" ] || cmp -l "$1/$of.map" /dev/zero >"$1/$of" 2>/dev/null || true
        [ ! -s "$1/$of" ] || blocks="$blocks $top/reach/$of.blocks $1/$of"
    done
    # shellcheck disable=SC2086 # pairs
    if [ -n "$blocks" ]; then awk -f "$here/lines.awk" $blocks; fi >"$1.lines"
    rm -rf "$1"
}

told() { # told KIND NAME PROGRAM...
    name="$1 $2"
    key=$(key "$1" "$2")
    line=$(grep -E "^[0-9.]+ $name $key" "$known" | tail -n 1 || true)
    reached=""
    case " $REACH " in *" $1 "*) reached=$top/reach/$(echo "$1.$2" | tr / _) ;; esac
    [ -z "$reached" ] || [ -e "$reached.lines" ] || line=""
    shift 2
    if [ -z "$line" ] || awk -v line="$line" -v longest="$LONGEST" -v always="$ALWAYS" 'BEGIN {
            split(line, t, " "); exit !(t[5] == "cut" && (t[1] < longest || (always != "" && t[3] ~ always))) }'; then
        cut=""
        limit=unlimited
        wall=$((360 * SLACK))
        if [ "$1" != sh ] && ! printf '%s\n' "${name#* }" | grep -qE "${ALWAYS:-^$}"; then
            limit=$((${LONGEST%.*} + 2))
            wall=$((limit * SLACK + 60)) # for programs that it starts
        fi
        if [ -z "$reached" ]; then
            took=$(used "$limit" "$wall" "$@")
        else
            rm -rf "$reached"
            mkdir -p "$reached"
            took=$(cd "$top/reaching" && REACH_FOLDER=$reached used "$limit" "$wall" "$@")
            lines_of "$reached"
        fi
        case ${took#* }$limit in
        0*) ;;
        *unlimited) failed "$name" ;;
        124* | 137* | 152*) cut=" cut" ;;
        *) failed "$name" ;;
        esac
        line="${took% *} $name $key$cut"
        echo "$line" >>"$known" # for who breaks this off
    fi
    echo "$line"
}

failed() { # failed NAME: told nothing of
    echo "$1" >>.failed
    exit 0
}

if [ $# -gt 2 ]; then
    case $3 in
    cli) told cli "$4" sh "$4" ;;
    host) told host "$4" build/tests/host "$4" ;;
    last) told last "$4" sh -c "$LAST" ;;
    *) told "$3" "$4" "build/tests/${CORE}_$3" "$4" ;;
    esac
    exit 0
fi

# What is one suite's or script's alone is not in the sum of the others.
common=$(sum_of Makefile $(find core hal boards host tests -type f ! -path 'tests/*/test_*' ! -path 'tests/cli/*.sh' | sort))
pages=$(sum_of $(find docs -type f ! -name testing.md ! -name mutants.md | sort))
export common pages JOBS
rm -f .failed
{
    [ -z "$LAST" ] || echo last campaign
    for build in host float double; do
        case " $STAGES " in *" $build "*) ;; *) continue ;; esac
        list=build/tests/${CORE}_suites.c
        [ "$build" != host ] || list=build/tests/host_suites.c
        sed -n "s/^void suite_\([a-z0-9_]*\)(void);/$build \1/p" "$list"
    done
    for script in tests/cli/*.sh; do
        case " $STAGES " in *" host "*) ;; *) break ;; esac
        case $script in
        */embed_* | */emitted_c.sh | */effects_cost_nothing.sh | */flags.sh | */interrupt.sh | */no_libm.sh) continue ;;
        */suites.sh | */worst_step_marks.sh | */columns.sh) continue ;;
        esac
        echo "cli $script"
    done
} | awk -v never="${NEVER:-^$}" '$2 !~ never' | xargs -P "$JOBS" -n 2 sh "$here/times.sh" "$PWD" "$known" | sort -n
if [ -e .failed ]; then
    echo "make mutants: these fail on the tree as it is:" $(cat .failed) >&2
    exit 1
fi
