#!/bin/sh
# figures.sh WHIRL OUT FIGURE.fig...: draws each figure as OUT/FIGURE.svg and OUT/FIGURE.png, from runs of the program
# WHIRL. `whirl figure` draws (host/io/figure_draw.c). OUT/data keeps the numbers.
#
# A .fig file describes one figure, one statement per line. # begins a comment.
#
#   title TEXT                  above the figure
#   caption TEXT                for docs/figures.md; a second caption line continues the text
#   run NAME SCENE OPTIONS      records of `whirl run`, called NAME below
#   sweep NAME SCENE OPTIONS    records of `whirl sweep`
#   table NAME SCRIPT WORDS     the CSV that mk/figures/SCRIPT prints when called with WHIRL and WORDS
#   panel YLABEL                begins a panel, below the one before
#   xlabel TEXT                 of the panel; without it, the last panel has "time [s]"
#   set TEXT                    a gnuplot setting for the panel
#   curve NAME | X | Y | TITLE [| STYLE]
#                               X and Y: gnuplot expressions of {column} names, without further braces
#                               TITLE: the curve's name; - for none. STYLE: gnuplot's; default: a line
#   law X-EXPRESSION | TITLE    a function of x, drawn thin and dashed
set -eu

whirl=${1:?usage: figures.sh WHIRL OUT FIGURE.fig...}
out=${2:?usage: figures.sh WHIRL OUT FIGURE.fig...}
shift 2
here=$(dirname "$0")
figures=$*
mkdir -p "$out/data"
trap 'rm -f "$out"/data/*.records' EXIT

# record KIND NAME WORDS...: makes OUT/data/....csv, unless another figure has made it, and prints its path. Files are
# named after the command, so figures share their runs.
record() {
    kind=$1
    shift 2
    file=$out/data/$kind-$(printf '%s' "$*" | tr -c 'A-Za-z0-9.\n' '_').csv
    raw=$file.raw status=0
    if [ ! -s "$file" ]; then
        rm -f "$raw" "$raw.sweep" # otherwise the sweep would continue from it
        case $kind in
        run) "$whirl" run "$@" --strict=off --quiet --csv "$raw" ;;
        sweep) "$whirl" sweep "$@" --strict=off --csv "$raw" >/dev/null ;;
        table) script=$1 && shift && sh "$here/$script" "$whirl" "$@" >"$raw" ;;
        esac || status=$?
        [ $status -ne 0 ] || tr -d '\r' <"$raw" >"$file"
        rm -f "$raw" "$raw.sweep" "$raw.toml"
        [ $status -eq 0 ] || { echo "figures.sh: cannot $kind $*" >&2; return 1; }
    fi
    printf '%s\n' "$file"
}

for fig in $figures; do
    name=$(basename "$fig" .fig)
    grep -E '^(run|sweep|table) ' "$fig" >"$out/data/$name.records" || true
    set --
    while read -r kind label words; do
        file=$(eval "record $kind $label $words") # because the words may be quoted
        set -- "$@" --data "$label=$file"
    done <"$out/data/$name.records"
    for kind in svg png; do
        "$whirl" figure "$fig" "$@" --out "$out/$name.$kind"
    done
    echo "  $name"
done
