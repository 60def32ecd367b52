#!/bin/sh
# worst_step_marks.sh: what `make worst-step` counts is found in the generated code of every scene with events.
. "$(dirname "$0")/../checks.sh"

CC=${CC:-gcc} sh mk/count/all_effects.sh "$whirl" "$scratch/marked" core/models/*.whirl >"$scratch/out" 2>"$scratch/err"
[ $? -eq 0 ] && [ "$(grep -l WH_MARK "$scratch"/marked/all_*.c | wc -l)" -ge 20 ] && [ -s "$scratch/marked/declared" ]
verdict $? "accelerations and signals of every scene with events are marked"
exit $failed
