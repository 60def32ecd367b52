#!/bin/sh
# into_page.sh TABLES PAGE NAME: replaces the text between two marks of the page by the tables. The marks are the comments
# "NAME: begin" and "NAME: end".
set -eu
tables=$1
page=$2
name=$3
for mark in begin end; do
    if [ "$(grep -c "^<!-- $name: $mark -->\$" "$page")" -ne 1 ]; then
        echo "into_page.sh: $page has no single line <!-- $name: $mark -->" >&2
        exit 1
    fi
done
awk -v tables="$tables" -v name="$name" '
    $0 == "<!-- " name ": end -->" { inside = 0 }
    !inside { print }
    $0 == "<!-- " name ": begin -->" {
        inside = 1
        print ""
        while ((getline line <tables) > 0) { print line }
        print ""
    }' "$page" >"$page.new"
mv "$page.new" "$page"
