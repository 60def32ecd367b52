#!/bin/sh
# pages.sh FOLDER PAGE...: renews the blocks of pages that show prices, from FOLDER/price.csv.
#
# A block stands between <!-- price-table WORDS: begin --> and <!-- price-table WORDS: end -->. tables.awk explains WORDS.
set -eu
here=$(dirname "$0")
folder=$1
shift
table=$(mktemp)
trap 'rm -f "$table"' EXIT
for page in "$@"; do
    sed -n 's/^<!-- price-table \(.*\): begin -->$/\1/p' "$page" >"$table.blocks"
    while read -r block; do
        awk -F, -v block="$block" -f "$here/words.awk" -f "$here/decades.awk" -f "$here/tables.awk" "$folder/price.csv" >"$table"
        "$here/../price/into_page.sh" "$table" "$page" "price-table $block"
    done <"$table.blocks"
    rm -f "$table.blocks"
done
