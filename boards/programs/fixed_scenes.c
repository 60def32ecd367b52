/* fixed_scenes.c: scenes.c for scenes in fixed point (`whirl derive --as c --number fixed`). */
#define SCENES_FIXED 1
#include "scenes.c" // NOLINT(bugprone-suspicious-include): the same program
