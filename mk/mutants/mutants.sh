#!/bin/sh
# mutants.sh: how many small changes of the code do the tests notice? For each folder of FOLDERS, MUTANTS changes
# are drawn at random (SEED; candidates.awk, draw.awk), built and tested one by one (work.sh) in copies of the
# tree under build/mutants; the table at the end is table.awk's. The tree itself is only read.
#
# FOLDERS   rows of the table: a folder, whose own .c and .h files are changed, or a pattern of files. A file that
#           the pattern of one row has is in no other row (core/contact* and the rest of core)
# MUTANTS   changes a row that compile to another object
# SEED      of the draw; printed
# EXCEPT    an extended regular expression: files that it matches are left alone
# LONGEST   seconds: a suite or script that takes longer on the tree as it is, is not run
# PATIENCE  seconds: a change that tests which take so long together did not notice has survived
# ALWAYS    an extended regular expression: those that it matches are run, however long they take
# NEVER     an extended regular expression: those that it matches are not asked
# SLACK     how many times as long as it works a test may take, waiting for others: more on a busy machine
# JOBS      how many work at the same time, each in a copy of its own, with niceness NICE
#
# Of a change of the core are built and asked, one after the other: the portable suites in double, the program with its suites
# and scripts, the portable suites in float. Of the program's only those are asked that reach the changed line.
#
# What was found stays in build/mutants/FOLDER.SEED.*: broken off, it goes on where it was. When tests change,
# only what had survived is tried again; when the folder's code changes, it starts anew.
set -eu

: "${FOLDERS:=core core/contact* core/rig host/algebra host/derive}" "${MUTANTS:=80}" "${EXCEPT:=^$}"
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
# A copy whose programs mark what they reach; the lines that each block of them has code of.
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
# What survived is tried again when there are other tests or more of them; what a test killed that is not to be asked, too.
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
        $2 == "survived" ? $4 == sum : $2 != "killed" || $3 !~ never' "$name.found" >"$name.kept"
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
