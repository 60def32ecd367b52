#!/bin/sh
# into_page.sh TABLES PAGE: put the tables between the page's two marks, in place of what is there.
set -eu
tables=$1
page=$2
for mark in begin end; do
    if [ "$(grep -c "^<!-- price-effects: $mark -->\$" "$page")" -ne 1 ]; then
        echo "into_page.sh: $page has no single line <!-- price-effects: $mark -->" >&2
        exit 1
    fi
done
awk -v tables="$tables" '
    /^<!-- price-effects: end -->$/ { inside = 0 }
    !inside { print }
    /^<!-- price-effects: begin -->$/ {
        inside = 1
        print ""
        while ((getline line <tables) > 0) { print line }
        print ""
    }' "$page" >"$page.new"
mv "$page.new" "$page"
