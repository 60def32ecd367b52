#!/bin/sh
# guards.sh [ROW...]: takes each guard of guards.rows away, in a copy of the tree under build/guards, and asks the suites beside
# it: one must fail. Rows are numbers from 1 on; all when left out. The tree itself is only read. Exit status 1: a guard is
# held by nothing, or its line is not found.
#
# ROWS     rows like guards.rows; TOP: the copy's folder
# PROGRAM  the test program; SUITES: those of rows that name none
# LAST     what else is asked, in the copy, where no suite fails: a command; MORE: what it needs built
# HELD     so many of a hundred must be held; 100 when left out
set -eu

here=mk/mutants
: "${MAKE:=make}" "${ROWS:=$here/guards.rows}" "${TOP:=build/guards}" "${PROGRAM:=build/tests/host}"
: "${SUITES:=}" "${LAST:=}" "${MORE:=}" "${HELD:=100}"
top=$TOP
mkdir -p "$top"
sh "$here/tree.sh" "$top/tree"
# shellcheck disable=SC2086 # lists
build() { (cd "$top/tree" && $MAKE "$PROGRAM" $MORE) >"$top/build.log" 2>&1; }
build || { tail "$top/build.log" >&2; exit 1; }

bad=0
number=0
tried=0
caught=0
while IFS='@' read -r name file change suites; do
    case $name in '#'* | '') continue ;; esac
    number=$((number + 1))
    case " $* " in "  " | *" $number "*) ;; *) continue ;; esac
    file=$(echo "$file" | tr -d ' ')
    change=$(echo "$change" | sed 's/^ *//; s/ *$//')
    verdict="held by nothing"
    held=""
    tried=$((tried + 1))
    : "${suites:=$SUITES}"
    cp -p "$file" "$top/kept"
    sed "$change" "$file" >"$top/tree/$file"
    if cmp -s "$file" "$top/tree/$file"; then
        verdict="its line is not there"
    elif ! build; then
        verdict="does not compile: $(grep -m 1 error "$top/build.log")"
    else
        for suite in $suites; do
            (cd "$top/tree" && sh tests/limit.sh 300 "$PROGRAM" "$suite") >"$top/$suite.log" 2>&1 ||
                held="$held, $suite ($(grep -o '[a-z_0-9]*:FAIL' "$top/$suite.log" | sed 's/:FAIL//' | head -n 1))"
        done
        if [ -z "$held" ] && [ -n "$LAST" ]; then
            (cd "$top/tree" && sh tests/limit.sh 300 sh -c "$LAST") >"$top/last.log" 2>&1 || held=", the last resort"
        fi
        [ -z "$held" ] || verdict="held by ${held#, }"
    fi
    cp -p "$top/kept" "$top/tree/$file"
    touch "$top/tree/$file"
    case $verdict in
    its* | does*) bad=1 ;;
    "held by nothing") ;;
    *) caught=$((caught + 1)) ;;
    esac
    printf '%2d %s: %s\n' "$number" "$(echo "$name" | sed 's/ *$//')" "$verdict"
done <"$ROWS"
echo "$caught of $tried caught"
[ $((caught * 100)) -ge $((tried * HELD)) ] || bad=1
exit $bad
