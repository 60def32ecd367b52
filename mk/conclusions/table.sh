#!/bin/sh
# table.sh print | check PAGE | renew PAGE [ROWS]: the dissertation's claims beside Whirl's numbers, as a Markdown table.
#
# ROWS (claims.rows) has the claims. Each command of the rows runs once; at most as many run at a time as there are
# processors. `check` fails if a verdict or a figure differs from PAGE. `renew` writes the table into PAGE.
set -eu
here=$(dirname "$0")
mode=${1:?usage: table.sh print | check PAGE | renew PAGE [ROWS]}
[ "$mode" = print ] || { page=${2:?table.sh: which page?}; shift; }
rows=${2:-$here/claims.rows}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

awk -v into="$scratch/" -f "$here/rows.awk" "$rows"
all=$(find "$scratch" -name '*.command' | wc -l)
echo "running the $all commands of the claims" >&2
find "$scratch" -name '*.command' | sort |
    xargs -P "$(nproc 2>/dev/null || echo 1)" -n 1 sh -c 'sh "$1" >"$1.said" 2>"$1.err" </dev/null || : >"$1.failed"; echo' _ |
    awk -v all="$all" 'NR % 10 == 0 || NR == all { print NR " of " all; fflush() }' >&2
for failed in "$scratch"/*.failed; do
    [ -e "$failed" ] || continue
    echo "error: $(cat "${failed%.failed}")" >&2
    tail -n 3 "${failed%.failed}.err" >&2
    exit 1
done
sort -n "$scratch/list" | while read -r row outputs; do
    [ -z "$outputs" ] || (cd "$scratch" && awk -F '[ ,()]+' -f "$row.take" $outputs) >"$scratch/$row.ours"
done
awk -v from="$scratch/" -f "$here/table.awk" "$scratch/rows" >"$scratch/table"
case $mode in
print) cat "$scratch/table" ;;
renew)
    awk -v table="$scratch/table" '
        /^\|/ { if (!done++) while ((getline line <table) > 0) print line; next }
        { print }' "$page" >"$scratch/page"
    cp "$scratch/page" "$page"
    ;;
check)
    grep '^|' "$page" >"$scratch/stated" || true
    awk -F ' [|] ' '
        FNR == NR { stated[$1 $2] = $6; next }
        $1 $2 in stated && stated[$1 $2] != $6 {
            print "error: the verdict has changed from \"" stated[$1 $2] "\" to \"" $6 "\":\n  " $0 > "/dev/stderr"
        }' "$scratch/stated" "$scratch/table"
    cmp -s "$scratch/stated" "$scratch/table" || {
        diff "$scratch/stated" "$scratch/table" | grep '^[<>]' | head -n 20 >&2
        echo "error: $page has another table than these commands give" >&2
        echo "hint: judge each changed row, then: make conclusions-renew" >&2
        exit 1
    }
    ;;
*) echo "table.sh: print, check or renew, not '$mode'" >&2; exit 2 ;;
esac
awk -F ' [|] ' 'NR > 2 { n[$6]++ }
    END { printf "%d claims: %d hold, %d do not, %d are opinions, %d not yet\n", NR - 2, n["holds"], n["does not hold"],
        n["opinion"], n["not yet"] }' "$scratch/table" >&2
