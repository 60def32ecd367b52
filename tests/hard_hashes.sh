#!/bin/sh
# hard_hashes.sh UNTIL FILE:SCENE...: what the interpreter makes of these scenes of docs/hard in float, until then: a line for
# each as boards/programs/scenes.c prints them.
set -eu
until=$1
shift
for scene in "$@"; do
    "${WHIRL:-build/whirl}" run "docs/hard/${scene%:*}.whirl:${scene#*:}" --number float --until "$until" 2>/dev/null |
        awk -v scene="${scene#*:}" '
            / steps to t = / { steps = $0; sub(/ steps to t = .*/, "", steps); sub(/.* /, "", steps) }
            /^state hash/ { print "scene " scene " steps " steps " hash " $3 " ok" }'
done
