#!/bin/sh
# hard_hashes.sh UNTIL FILE:SCENE[:OPTIONS]...: the interpreter's hashes of these scenes of docs/hard in float at that time,
# a line for each as boards/programs/scenes.c prints them. OPTIONS as in mk/hard.mk, +compensated+stabilized.
set -eu
until=$1
shift
for scene in "$@"; do
    file=${scene%%:*}
    name=${scene#*:}
    options=${name#"${name%%:*}"}
    name=${name%%:*}
    "${WHIRL:-build/whirl}" run "docs/hard/$file.whirl:$name" --number float --until "$until" \
        $(printf '%s' "${options#:}" | sed 's/+/ --/g') 2>/dev/null |
        awk -v scene="$name" '
            / steps to t = / { steps = $0; sub(/ steps to t = .*/, "", steps); sub(/.* /, "", steps) }
            /^state hash/ { print "scene " scene " steps " steps " hash " $3 " ok" }'
done
