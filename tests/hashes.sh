#!/bin/sh
# hashes.sh LOGS NAME COMMAND... [-- TITLE NAME COMMAND...]...: runs the same scenes in several ways and compares their
# bits.
#
# Each command prints a line "scene NAME steps N hash 0x..." for each scene, or "without NAME" if it cannot run the
# scene. All lines must equal those of the first command. After a "--" and a title another comparison begins, with a
# first command of its own. HASH_SECONDS limits the processor time of each command (limit.sh). Each command's name is
# printed when it begins. The last line is "N runs of the scenes: the same bits in all", or the number of those that
# differ; the exit status is 0 or 1.
set -u

[ "${HASH_SECONDS:=1800}" -gt 0 ] 2>/dev/null || {
    echo "hashes.sh: error: HASH_SECONDS=$HASH_SECONDS: seconds, 1 or more" >&2
    exit 2
}
logs=${1:?usage: hashes.sh LOGS NAME COMMAND... [-- TITLE NAME COMMAND...]...}
shift
mkdir -p "$logs" || exit 1
runs=0
bad=0
first=""
firsts=""

while [ $# -ge 2 ]; do
    if [ "$1" = -- ]; then
        echo "$2"
        first=""
        shift 2
        continue
    fi
    name=$1
    command=$2
    shift 2
    start=$(date +%s)
    printf '  %-18s ' "$name"
    file=$logs/$(echo "$name" | tr ' ' '_').txt
    sh tests/limit.sh "$HASH_SECONDS" sh -c "$command" </dev/null >"$file.raw" 2>"$file.err"
    status=$?
    tr -d '\r' <"$file.raw" | grep '^scene ' | sort >"$file"
    [ -n "$first" ] || { first=$file && firsts="$firsts $file"; }
    tr -d '\r' <"$file.raw" | sed -n 's/^without \(.*\)/scene \1 /p' >"$file.without"
    grep -vF -f "$file.without" "$first" >"$file.wanted"
    large=$(wc -l <"$file.without")
    count=$(wc -l <"$file")
    if [ "$status" -eq 152 ]; then
        verdict="FAILED: more than $HASH_SECONDS s of processor"
    elif [ "$status" -eq 124 ] || [ "$status" -eq 137 ]; then
        verdict="FAILED: did not end"
    elif [ "$status" -ne 0 ]; then
        verdict="FAILED: exit status $status: $(head -n 1 "$file.err")"
    elif [ "$count" -eq 0 ]; then
        verdict="FAILED: no scene ran"
    elif ! cmp -s "$file.wanted" "$file"; then
        verdict="differs"
    else
        verdict="same bits"
    fi
    runs=$((runs + 1))
    [ "$verdict" = "same bits" ] || bad=$((bad + 1))
    said=$verdict
    [ "$large" -eq 0 ] || said="$verdict; $large scenes are too large"
    printf '%3d scenes   %s   %d s\n' "$count" "$said" "$(($(date +%s) - start))"
    if [ "$verdict" = differs ]; then
        diff "$file.wanted" "$file" | grep '^[<>]' | head -n 6 | sed 's/^/        /'
    fi
done
echo
cat $firsts
echo
if [ "$runs" -gt 0 ] && [ "$bad" -eq 0 ]; then
    echo "$runs runs of the scenes: the same bits in all"
else
    echo "$bad of $runs runs of the scenes differ or failed"
    exit 1
fi
