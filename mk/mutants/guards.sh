#!/bin/sh
# guards.sh [ROW...]: removes each guard of guards.rows in a copy of the tree under build/guards, and runs the suites
# in its row, of which one must fail. Rows are numbers from 1 on; without numbers, all rows. The tree itself is only
# read. Exit status 1: no suite notices a missing guard, or its line is not found.
set -eu

here=mk/mutants
: "${MAKE:=make}"
top=build/guards
mkdir -p "$top"
sh "$here/tree.sh" "$top/tree"
build() { (cd "$top/tree" && $MAKE build/tests/host) >"$top/build.log" 2>&1; }
asked() { (cd "$top/tree" && sh tests/limit.sh 300 "$@") >"$top/asked.log" 2>&1; }
build || { tail "$top/build.log" >&2; exit 1; }

bad=0 number=0 tried=0 caught=0
while IFS='@' read -r name file change suites; do
    case $name in '#'* | '') continue ;; esac
    number=$((number + 1))
    case " $* " in "  " | *" $number "*) ;; *) continue ;; esac
    file=$(echo "$file" | tr -d ' ')
    held=""
    tried=$((tried + 1))
    cp -p "$file" "$top/kept"
    sed "$(echo "$change" | sed 's/^ *//; s/ *$//')" "$file" >"$top/tree/$file"
    if cmp -s "$file" "$top/tree/$file"; then
        verdict="its line is not there" bad=1
    elif ! build; then
        verdict="does not compile: $(grep -m 1 error "$top/build.log")" bad=1
    else
        for suite in $suites; do
            asked build/tests/host "$suite" ||
                held="$held, $suite ($(grep -o '[a-z_0-9]*:FAIL' "$top/asked.log" | sed 's/:FAIL//' | head -n 1))"
        done
        [ -n "$held" ] && caught=$((caught + 1)) || bad=1
        verdict="held by ${held:-, nothing}"
        verdict="held by ${verdict#held by , }"
    fi
    cp -p "$top/kept" "$top/tree/$file"
    touch "$top/tree/$file"
    printf '%2d %s: %s\n' "$number" "$(echo "$name" | sed 's/ *$//')" "$verdict"
done <"$here/guards.rows"
echo "$caught of $tried caught"
exit $bad
