/* pil_dialled.c: pil_rig.c with dials for the set-point and for the compensated part of gravity's torque. The operator
 * sets them before the program arms (docs/pil.md). */
#define RIG_DIALLED 1
#include "pil_rig.c" // NOLINT(bugprone-suspicious-include): the same program
