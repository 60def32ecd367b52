#!/bin/sh
# maps.sh WHIRL DOCS: the stability maps that docs/stability.md shows, DOCS/figures/map_*.svg: each is drawn by the command
# that stands below it there, so that no map is of another run than it says.
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
