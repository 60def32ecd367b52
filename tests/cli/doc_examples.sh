#!/bin/sh
# doc_examples.sh: every ```whirl block of the documents is a complete file that derives.
set -u

whirl=${WHIRL:-build/whirl}
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
failed=0
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
    if "$whirl" derive "$example" >/dev/null 2>"$scratch/errors"; then
        echo "ok - $name"
    else
        echo "not ok - $name"
        sed 's/^/    /' "$scratch/errors"
        failed=1
    fi
done

if [ "$count" -lt 4 ]; then
    echo "not ok - only $count examples found: run from the project's root"
    failed=1
fi
exit $failed
