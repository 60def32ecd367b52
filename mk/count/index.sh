#!/bin/sh
# index.sh NAME...: the table of these scenes as C, for programs of boards/programs, on standard output. Their headers,
# NAME.h, stand beside the file that it goes into.
set -eu

echo '#include "boards/programs/table.h"'
for name in "$@"; do
    echo "#include \"$name.h\""
done
echo 'const wh_scene *const wh_scenes[] = {'
for name in "$@"; do
    echo "    &$name,"
done
echo '};'
echo 'const wh_scene_bound wh_scene_bounds[] = {'
for name in "$@"; do
    echo "    {${name}_EVALUATIONS, ${name}_SIGNALS},"
done
echo '};'
echo 'const unsigned wh_scene_count = sizeof wh_scenes / sizeof wh_scenes[0];'
