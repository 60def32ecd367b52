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
mkdir -p "$TOP"
sh "$here/tree.sh" "$TOP/tree"
# shellcheck disable=SC2086 # lists
build() { (cd "$TOP/tree" && $MAKE "$PROGRAM" $MORE) >"$TOP/build.log" 2>&1; }
asked() { (cd "$TOP/tree" && sh tests/limit.sh 300 "$@") >"$TOP/asked.log" 2>&1; }
build || { tail "$TOP/build.log" >&2; exit 1; }

bad=0 number=0 tried=0 caught=0
while IFS='@' read -r name file change suites; do
    case $name in '#'* | '') continue ;; esac
    number=$((number + 1))
    case " $* " in "  " | *" $number "*) ;; *) continue ;; esac
    file=$(echo "$file" | tr -d ' ')
    held=""
    tried=$((tried + 1))
    cp -p "$file" "$TOP/kept"
    sed "$(echo "$change" | sed 's/^ *//; s/ *$//')" "$file" >"$TOP/tree/$file"
    if cmp -s "$file" "$TOP/tree/$file"; then
        verdict="its line is not there" bad=1
    elif ! build; then
        verdict="does not compile: $(grep -m 1 error "$TOP/build.log")" bad=1
    else
        for suite in ${suites:-$SUITES}; do
            asked "$PROGRAM" "$suite" ||
                held="$held, $suite ($(grep -o '[a-z_0-9]*:FAIL' "$TOP/asked.log" | sed 's/:FAIL//' | head -n 1))"
        done
        if [ -z "$held" ] && [ -n "$LAST" ]; then asked sh -c "$LAST" || held=", the last resort"; fi
        [ -z "$held" ] || caught=$((caught + 1))
        verdict="held by ${held:-, nothing}"
        verdict="held by ${verdict#held by , }"
    fi
    cp -p "$TOP/kept" "$TOP/tree/$file"
    touch "$TOP/tree/$file"
    printf '%2d %s: %s\n' "$number" "$(echo "$name" | sed 's/ *$//')" "$verdict"
done <"$ROWS"
echo "$caught of $tried caught"
[ $((caught * 100)) -ge $((tried * HELD)) ] || bad=1
exit $bad
