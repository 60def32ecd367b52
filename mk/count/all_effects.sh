#!/bin/sh
# all_effects.sh WHIRL OUT MODEL...: every scene with stops, friction, holds or crossings as C into OUT, with all
# the effects of its mechanism on: SCENE.c and SCENE.h, and scenes.c that lists them.
set -eu
whirl=$1 out=$2
shift 2
rm -rf "$out"
mkdir -p "$out"

# lines "FILE:SCENE SCENE" of scenes with contacts, in the mechanism, in one of its effects or in the scene itself
"$whirl" list --as table "$@" >"$out/table"
awk -F '\t' '
    $8 ~ /contacts/ && $1 != "scene" { has[$4, $3] = 1 }
    $1 == "scene" && (has[$4, $3] || $8 ~ /contacts/) { print $4 ":" $2, $2 }' "$out/table" >"$out/list"

scenes=
while read -r where scene; do
    if "$whirl" derive "$where" --with all --as c --header "$out/$scene.h" >"$out/$scene.c" 2>"$out/errors"; then
        scenes="$scenes $scene"
    else # for example a momentum that is conserved only without drag
        echo "$scene with all effects: $(head -n 1 "$out/errors")" >&2
        rm -f "$out/$scene.c" "$out/$scene.h"
    fi
done <"$out/list"
if [ -z "$scenes" ]; then
    echo "all_effects.sh: no scene has stops, friction, holds or crossings in $*" >&2
    exit 1
fi
"$(dirname "$0")/index.sh" $scenes >"$out/scenes.c"
