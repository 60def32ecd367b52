#!/bin/sh
# index.sh [--fixed] NAME...: prints the table of these scenes as C, for programs of boards/programs. Their headers,
# NAME.h, must be in the folder of the file that includes the table. --fixed: scenes in fixed point, without bounds.
set -eu
kind=
if [ "$1" = --fixed ]; then
    kind=fixed_
    shift
fi

echo '#include "boards/programs/table.h"'
for name in "$@"; do
    echo "#include \"$name.h\""
done
echo "const wh_${kind}scene *const wh_${kind}scenes[] = {"
for name in "$@"; do
    echo "    &$name,"
done
echo '};'
if [ -z "$kind" ]; then
    echo 'const wh_scene_bound wh_scene_bounds[] = {'
    for name in "$@"; do
        echo "    {${name}_EVALUATIONS, ${name}_SIGNALS},"
    done
    echo '};'
fi
echo "const unsigned wh_scene_count = sizeof wh_${kind}scenes / sizeof wh_${kind}scenes[0];"
