/* fixed_scenes.c: the same program as scenes.c, for scenes in fixed point (`whirl derive --as c --number fixed`). */
#define SCENES_FIXED 1
#include "boards/programs/to_the_end.h"

int main(void) { board_exit(run_all_to_the_end()); }
