#!/bin/sh
# times.sh TREE KNOWN: what each suite and each script takes in a built tree, quickest first:
#   seconds of a processor, "host", "float", "double", "cli" or "last", its name
# Each is run, and must pass: what fails on the tree as it is would kill every change. What KNOWN, a file of such
# lines, says to take longer than LONGEST is not run again, and what NEVER matches is not run at all. A suite that will
# not be asked for its length is not run to its end: what it had taken by then stands for its time. Scripts that say
# nothing about the folders that are changed, or that need other compilers, are left out.
set -eu
known=$2
cd "$1"
export WHIRL=build/whirl
rm -f .failed

used() { # used LIMIT COMMAND...: seconds of a processor, of it and its children, and the exit status
    sh -c 'limit=$1; shift; (ulimit -t $limit && ulimit -c 0 && exec "$@") >/dev/null 2>&1 </dev/null; status=$?; times; echo $status' sh "$@" |
        awk 'NR == 2 { split($1, user, /[ms]/); split($2, sys, /[ms]/) }
             NR == 3 { print user[1] * 60 + user[2] + sys[1] * 60 + sys[2], $1 }'
}

told() { # told KIND NAME PROGRAM...
    name="$1 $2"
    ! printf '%s\n' "$2" | grep -qE "${NEVER:-^$}" || return 0
    shift 2
    line=$(grep -E "^[0-9.]+ $name\$" "$known" || true)
    if [ -z "$line" ] || awk -v line="$line" -v longest="$LONGEST" -v always="$ALWAYS" 'BEGIN {
            split(line, t, " "); exit t[1] > longest && (always == "" || t[3] !~ always) }'; then
        limit=unlimited
        [ "$1" = sh ] || printf '%s\n' "${name#* }" | grep -qE "${ALWAYS:-^$}" || limit=$(awk -v longest="$LONGEST" 'BEGIN { print int(longest) + 2 }')
        took=$(used "$limit" "$@")
        line="${took% *} $name"
        case ${took#* } in
        0) ;;
        137 | 152) [ "$limit" != unlimited ] || echo "$name" >>.failed ;;
        *) echo "$name" >>.failed ;;
        esac
    fi
    echo "$line"
}

{
    [ -z "$LAST" ] || told last campaign sh -c "$LAST"
    for build in host float double; do
        case " $STAGES " in *" $build "*) ;; *) continue ;; esac
        program=build/tests/${CORE}_$build
        list=build/tests/${CORE}_suites.c
        if [ "$build" = host ]; then
            program=build/tests/host
            list=build/tests/host_suites.c
        fi
        for suite in $(sed -n 's/^void suite_\([a-z0-9_]*\)(void);/\1/p' "$list"); do
            told "$build" "$suite" "$program" "$suite"
        done
    done
    for script in tests/cli/*.sh; do
        case " $STAGES " in *" host "*) ;; *) break ;; esac
        case $script in
        */embed_* | */emitted_c.sh | */effects_cost_nothing.sh | */flags.sh | */interrupt.sh | */no_libm.sh) continue ;;
        */suites.sh | */worst_step_marks.sh | */columns.sh) continue ;;
        esac
        told cli "$script" sh "$script"
    done
} | sort -n
if [ -e .failed ]; then
    echo "make mutants: these fail on the tree as it is:" $(cat .failed) >&2
    exit 1
fi
