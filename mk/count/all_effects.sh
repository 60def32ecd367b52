#!/bin/sh
# all_effects.sh WHIRL OUT MODEL...: every scene with stops, friction, holds or crossings as C into OUT, with all
# the effects of its mechanism on (all_SCENE.c), OUT/scenes.c that lists them, and OUT/declared: lines "SCENE
# EVALUATIONS SIGNALS", what a step of it may take. The accelerations are marked as kind 1, the signals as kind 2
# (mark.h).
set -eu
whirl=$1 out=$2
shift 2
rm -rf "$out"
mkdir -p "$out"

# lines "FILE:SCENE SCENE EFFECT,EFFECT,..."
awk '
    FNR == 1 { mechanism = "" }
    $1 == "mechanism" { mechanism = $2 }
    $1 == "effect" { # some awks make the element that is assigned to before they ask whether it is there
        before = mechanism in effects ? effects[mechanism] "," : ""
        effects[mechanism] = before $2
    }
    $1 == "scene" { scene[++count] = $2; file[count] = FILENAME; of[count] = mechanism }
    $1 == "use" { of[count] = $2 }
    END { for (i = 1; i <= count; i++) print file[i] ":" scene[i], scene[i], effects[of[i]] }
' "$@" >"$out/list"

while read -r where scene effects; do
    if ! "$whirl" derive "$where" ${effects:+--with "$effects"} --as c >"$out/all_$scene.c" 2>"$out/errors"; then
        # such as a momentum that is conserved only without drag
        echo "$scene with all effects: $(head -n 1 "$out/errors")" >&2
        rm "$out/all_$scene.c"
    elif ! grep -q 'WH_CONTACT_EVALUATIONS' "$out/all_$scene.c"; then
        rm "$out/all_$scene.c"
    else
        sed -e '/^#define WH_COORDS/i #include "boards/programs/mark.h"' \
            -e '/^static inline void accelerations(/,/^}/s/^    (void)model;/    WH_MARK(1);\n&/' \
            -e '/^static inline void contact_signals(/,/^}/s/^    (void)model;/    WH_MARK(2);\n&/' \
            "$out/all_$scene.c" >"$out/marked"
        if [ "$(grep -c '^    WH_MARK' "$out/marked")" -ne 2 ]; then
            echo "all_effects.sh: $scene: where are its accelerations and its signals?" >&2
            exit 1
        fi
        mv "$out/marked" "$out/all_$scene.c"
    fi
done <"$out/list"
if ! ls "$out"/all_*.c >/dev/null 2>&1; then
    echo "all_effects.sh: no scene has stops, friction, holds or crossings in $*" >&2
    exit 1
fi
{
    echo '#include "core/scene.h"'
    echo 'extern const wh_scene *const wh_scenes[];'
    echo 'extern const unsigned wh_scene_count;'
    for file in "$out"/all_*.c; do
        scene=$(basename "$file" .c)
        echo "extern const wh_scene ${scene#all_};"
    done
    echo 'const wh_scene *const wh_scenes[] = {'
    for file in "$out"/all_*.c; do
        scene=$(basename "$file" .c)
        echo "    &${scene#all_},"
    done
    echo '};'
    echo 'const unsigned wh_scene_count = sizeof wh_scenes / sizeof wh_scenes[0];'
} >"$out/scenes.c"

{
    printf '#define WH_DOUBLE 0\n#include "core/contact.h"\n'
    for file in "$out"/all_*.c; do
        scene=$(basename "$file" .c)
        awk -F '[(,) ]+' -v scene="${scene#all_}" '
            $2 == ".contacts" { contacts = $4 }
            $4 == "WH_CONTACT_EVALUATIONS" { stages = $5; stops = $6; forced = $7 }
            END {
                printf "declared %s evaluations WH_CONTACT_EVALUATIONS(%d, %d, %d)", scene, stages, stops, forced
                printf " signals WH_CONTACT_SIGNALS(%d, %d)\n", forced, contacts - forced
            }' "$file"
    done
} | "${CC:-cc}" -E -P -I. - |
    sed -n 's/^declared \([a-z0-9_]*\) evaluations \(.*\) signals \(.*\)/echo \1 $((\2)) $((\3))/p' | sh >"$out/declared"
