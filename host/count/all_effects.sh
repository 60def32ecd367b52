#!/bin/sh
# all_effects.sh WHIRL OUT MODEL...: every scene with stops, friction, holds or crossings as C into OUT, with all
# the effects of its mechanism on (all_SCENE.c), and OUT/scenes.c that lists them.
set -eu
whirl=$1 out=$2
shift 2
rm -rf "$out"
mkdir -p "$out"

# lines "SCENE EFFECT,EFFECT,..."
awk '
    FNR == 1 { mechanism = "" }
    $1 == "mechanism" { mechanism = $2 }
    $1 == "effect" { effects[mechanism] = effects[mechanism] (mechanism in effects ? "," : "") $2 }
    $1 == "scene" { scene[++count] = $2; of[count] = mechanism }
    $1 == "use" { of[count] = $2 }
    END { for (i = 1; i <= count; i++) if (of[i] in effects) print scene[i], effects[of[i]] }
' "$@" >"$out/list"

while read -r scene effects; do
    if ! "$whirl" derive "$scene" --with "$effects" --as c >"$out/all_$scene.c" 2>"$out/errors"; then
        # such as a momentum that is conserved only without drag
        echo "$scene with all effects: $(head -n 1 "$out/errors")" >&2
        rm "$out/all_$scene.c"
    elif ! grep -q 'WH_CONTACT_EVALUATIONS' "$out/all_$scene.c"; then
        rm "$out/all_$scene.c"
    fi
done <"$out/list"
{
    echo '#include "build/gen/scenes.h"'
    echo 'const wh_scene *const wh_scenes[] = {'
    for file in "$out"/all_*.c; do
        scene=$(basename "$file" .c)
        echo "    &${scene#all_},"
    done
    echo '};'
    echo 'const unsigned wh_scene_count = sizeof wh_scenes / sizeof wh_scenes[0];'
} >"$out/scenes.c"

echo "Evaluations of the accelerations that a step may take, as the generated files declare:"
for file in "$out"/all_*.c; do
    scene=$(basename "$file" .c)
    sed -n 's/.*WH_CONTACT_EVALUATIONS(\([0-9]*\), \([0-9]*\), \([0-9]*\)).*/\1 \2 \3/p' "$file" |
        while read -r stages stops forced; do
            printf '  %-28s %s\n' "${scene#all_}" \
                "$(printf '#define WH_DOUBLE 0\n#include "core/contact.h"\nWH_CONTACT_EVALUATIONS(%s, %s, %s)\n' \
                    "$stages" "$stops" "$forced" | "${CC:-cc}" -E -P -I. - | tail -n 1 |
                    sed 's/^/echo $((/; s/$/))/' | sh)"
        done
done
