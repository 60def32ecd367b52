#!/bin/sh
# maps.sh WHIRL DOCS: draws the stability maps of docs/stability.md, DOCS/figures/map_*.svg. Each command is the one
# printed below the map on the page, so that the two agree.
set -eu
whirl=${1:?usage: maps.sh WHIRL DOCS}
docs=${2:?usage: maps.sh WHIRL DOCS}
mkdir -p "$docs/figures"
sed -e ':join' -e '/\\$/{N;s/ *\\\n */ /;b join' -e '}' "$docs/stability.md" | grep '^build/whirl map .*--plot docs/figures/map_' |
    while read -r call; do
        words=${call#build/whirl }
        eval "\"\$whirl\" ${words%docs/figures/*}\"\$docs\"/figures/${words##*/} --quiet"
        echo "Drawn: $docs/figures/${words##*/}"
    done
