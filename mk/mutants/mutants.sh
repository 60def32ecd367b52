#!/bin/sh
# mutants.sh: how many small changes of the code do the tests notice? For each row of FOLDERS, MUTANTS changes are drawn
# at random (candidates.awk, draw.awk), built and tested one by one (work.sh) in copies of the tree under build/mutants.
# table.awk makes the table at the end. The tree itself is only read.
#
# FOLDERS   rows of the table: a folder, whose own .c and .h files are changed, or a pattern of files. A file that
#           belongs to a pattern is in no other row (core/contact* and the rest of core)
# MUTANTS   number of changes per row; a change that compiles to the same object does not count
# SEED      seed of the draw; it is printed
# EXCEPT    extended regular expression: files that are not changed
# LONGEST   seconds: a test that takes longer on the unchanged tree is not run
# PATIENCE  seconds: if tests that take so long together do not notice a change, it has survived
# ALWAYS    extended regular expression: tests that are run, however long they take
# NEVER     extended regular expression: tests that are not run
# SLACK     limit of a test's duration, divided by its processor time: more on a busy machine
# JOBS      number of jobs at the same time, each in its own copy, with niceness NICE
#
# For a change of the core, these run in this order: the portable suites in double, the program's suites and scripts,
# the portable suites in float. Of the program's tests, only those run that reach the changed line.
#
# Results stay in build/mutants/FOLDER.SEED.*, and an interrupted run continues from them. If tests have changed, only
# survivors are tried again. If the folder's code has changed, its row begins again.
set -eu

: "${FOLDERS:=core core/contact* core/rig host/algebra host/derive host/image}" "${MUTANTS:=80}" "${EXCEPT:=^$}"
: "${LONGEST:=60}" "${PATIENCE:=600}" "${SLACK:=10}" "${ALWAYS:=}" "${NEVER:=^$}" "${JOBS:=2}" "${SEED:=$(date +%s)}" "${NICE:=19}" "${MAKE:=make}"
top=build/mutants
here=mk/mutants
asked="$LONGEST.$PATIENCE.$ALWAYS.$NEVER"
export JOBS LONGEST PATIENCE SLACK ALWAYS NEVER

# --- copies -------------------------------------------------------------------------------------------
# Times are kept, so that nothing is compiled that is up to date. The first copy is never changed; the
# others, one a job, are put back from it after each change.
sum_of_all() { find "$@" -type f ! -path docs/dev/testing.md ! -path docs/dev/mutants.md | sort | xargs cat | cksum | tr -d ' '; }
sum=$(sum_of_all Makefile core hal boards host tests docs)
is() { [ "$(cat "$1" 2>/dev/null || true)" = "$2" ]; } # is FILE TEXT
made() { # made TREE COMMAND...: run there, quietly
    (cd "$1" && shift && "$@") >"$top/build.log" 2>&1 || {
        tail "$top/build.log" >&2
        exit 1
    }
}
mkdir -p "$top"
if ! is "$top/sum" "$sum"; then
    rm -rf "$top/sum" "$top"/src[0-9]*
    sh "$here/tree.sh" "$top/src"
    made "$top/src" sh -c "$MAKE build/whirl && $MAKE build/gen/.stamp && $MAKE test-programs"
    echo "$sum" >"$top/sum"
fi
for job in $(seq "$JOBS"); do
    if [ -e "$top/src$job/.changed" ] || [ ! -e "$top/src$job/.whole" ]; then
        rm -rf "$top/src$job"
        cp -a "$top/src" "$top/src$job"
        touch "$top/src$job/.whole"
    fi
done

# --- what every test takes on the tree as it is, and what it reaches --------------------------------------
# A copy whose programs record which lines they reach, with the lines of code of each block.
if ! is "$top/reach/sum" "$sum"; then
    mkdir -p "$top/reach"
    if [ ! -d "$top/reaching" ]; then
        cp -a "$top/src" "$top/reaching.new"
        rm -rf "$top"/reaching.new/build/*/core "$top"/reaching.new/build/*/host "$top"/reaching.new/build/*/tests
        mv "$top/reaching.new" "$top/reaching"
    fi
    sh "$here/tree.sh" "$top/reaching"
    made "$top/reaching" $MAKE reachers-now \
        REACHED="-Og -Wno-maybe-uninitialized -Wno-format-truncation -fsanitize-coverage=trace-pc"
    find core host -name '*.[ch]' >"$top/reach/files"
    for program in whirl tests/host; do
        objdump -dl --no-show-raw-insn "$top/reaching/build/$program" |
            awk -f "$here/blocks.awk" "$top/reach/files" - >"$top/reach/${program#*/}.blocks"
    done
    awk -v all=1 -f "$here/lines.awk" "$top/reach/whirl.blocks" "$top/reach/host.blocks" >"$top/reach/counted"
    echo "$sum" >"$top/reach/sum"
fi
# Lines: seconds of a processor, "host", "float", "double" or "cli", the suite's or script's name, a sum.
if ! is "$top/times.sum" "$sum.$asked"; then
    touch "$top/times"
    nice -n "$NICE" sh "$here/times.sh" "$top/src" "$PWD/$top/times" >"$top/times.new"
    mv "$top/times.new" "$top/times"
    echo "$sum.$asked" >"$top/times.sum"
fi
# A survivor is tried again if tests have changed or more of them are run. So is a mutant whose killer is no longer run.
tests_sum=$(sum_of_all tests).$(echo "$asked" | cksum | tr -d ' ')

# --- the draw, the work, the table ----------------------------------------------------------------------
echo "Mutants drawn with SEED=$SEED, $MUTANTS a folder; tests of up to $LONGEST s, of up to $PATIENCE s together."
tables=""
set -f # patterns among the rows stay what they are
patterns=$(printf '%s\n' $FOLDERS | grep -F '*' || true)
files_of() { set +f && ls -d $1 | grep -E '\.[ch]$' && set -f; }
for row in $FOLDERS; do
    case $row in
    *'*'*) files=$(files_of "$row") ;;
    *)
        files=$(files_of "$row/*")
        for pattern in $patterns; do files=$(printf '%s\n' $files | grep -vxF "$(files_of "$pattern")"); done
        ;;
    esac
    files=$(printf '%s\n' $files | grep -vE "$EXCEPT")
    name=$top/$(echo "${row%\*}" | tr / _).$SEED.$(sum_of_all $files)
    awk -f "$here/candidates.awk" $files |
        awk -v seed="$SEED" -v count=$((MUTANTS * 4)) -f "$here/draw.awk" >"$name.drawn"
    touch "$name.found"
    awk -F '\t' -v sum="$tests_sum" -v never="$NEVER" '
        $2 == "survived" ? $4 "" == sum : $2 != "killed" || $3 !~ never' "$name.found" >"$name.kept"
    mv "$name.kept" "$name.found"
    rm -rf "$name.claims"
    mkdir "$name.claims"
    echo "$row" >"$name.row"
    tables="$tables $name"
done
workers=""
trap 'kill $workers 2>/dev/null; exit 130' INT TERM
for job in $(seq "$JOBS"); do
    # The first begins with the first folder, the second with the last, and so on in turns.
    nice -n "$NICE" sh "$here/work.sh" "$top" "$job" "$MUTANTS" "$tests_sum" $tables 2>>"$top/errors" &
    workers="$workers $!"
    tables=$(printf '%s\n' $tables | tac)
done
wait
for name in $tables; do
    rm -rf "$name.claims"
    awk -v wanted="$MUTANTS" -v row="$(cat "$name.row")" -f "$here/table.awk" "$name.drawn" "$name.found"
done
