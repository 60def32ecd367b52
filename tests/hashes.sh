#!/bin/sh
# hashes.sh LOGS [NAME COMMAND]...: run the same scenes in several ways and compare their bits.
#
# Each command prints a line "scene NAME steps N hash 0x..." for each scene. The first is what the
# others are held against. Fails when a line is missing or another. A command that cannot run a scene says so in a line
# "without NAME".
set -u

logs=${1:?usage: hashes.sh LOGS [NAME COMMAND]...}
shift
mkdir -p "$logs"
names=""
bad=0
first=""

while [ $# -ge 2 ]; do
    name=$1
    command=$2
    shift 2
    file=$logs/$(echo "$name" | tr ' ' '_').txt
    timeout --kill-after=5 1800 sh -c "$command" </dev/null >"$file.raw" 2>"$file.err"
    status=$?
    tr -d '\r' <"$file.raw" | grep '^scene ' | sort >"$file"
    [ -n "$first" ] || first=$file
    tr -d '\r' <"$file.raw" | sed -n 's/^without \(.*\)/scene \1 /p' >"$file.without"
    grep -vF -f "$file.without" "$first" >"$file.wanted"
    large=$(wc -l <"$file.without")
    count=$(wc -l <"$file")
    if [ "$status" -ne 0 ]; then
        verdict="FAILED: exit status $status: $(head -n 1 "$file.err")"
    elif [ "$count" -eq 0 ]; then
        verdict="FAILED: no scene ran"
    elif ! cmp -s "$file.wanted" "$file"; then
        verdict="differs"
    else
        verdict="same bits"
    fi
    [ "$verdict" = "same bits" ] || bad=$((bad + 1))
    said=$verdict
    [ "$large" -eq 0 ] || said="$verdict; $large scenes are too large"
    printf '  %-18s %3d scenes   %s\n' "$name" "$count" "$said"
    if [ "$verdict" = differs ]; then
        diff "$file.wanted" "$file" | grep '^[<>]' | head -n 6 | sed 's/^/        /'
    fi
done
echo
cat "$first"
[ "$bad" -eq 0 ] || { echo "$bad of the runs differ or failed"; exit 1; }
