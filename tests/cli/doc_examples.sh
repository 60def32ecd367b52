#!/bin/sh
# doc_examples.sh: every ```whirl block of the documents is a complete file that derives.
. "$(dirname "$0")/../checks.sh"

count=0

for document in README.md docs/*.md; do
    [ -f "$document" ] || continue
    awk -v stem="$scratch/$(basename "$document" .md)" '
        /^```whirl/ { file = stem "-" NR ".whirl"; next }
        /^```/ { file = "" }
        file != "" { print > file }' "$document"
done

for example in "$scratch"/*.whirl; do
    [ -f "$example" ] || continue
    count=$((count + 1))
    name=$(basename "$example" .whirl) # document and line
    "$whirl" derive "$example" >/dev/null 2>"$scratch/err"
    verdict $? "$name"
done

[ "$count" -ge 4 ]
verdict $? "$count examples found (run from the project's root)" /dev/null
exit $failed
