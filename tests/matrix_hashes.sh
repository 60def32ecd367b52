#!/bin/sh
# matrix_hashes.sh SCENE...: the interpreter's hashes of these scenes in float, with a step as one exact matrix; a line for
# each as boards/programs/scenes.c prints them.
set -eu
for scene in "$@"; do
    "${WHIRL:-build/whirl}" run "$scene" --matrix exact --number float | awk -v scene="$scene" '
        / steps to t = / { steps = $0; sub(/ steps to t = .*/, "", steps); sub(/.* /, "", steps) }
        /^state hash/ { print "scene " scene " steps " steps " hash " $3 " ok" }'
done
