/* pil_dialled.c: pil_rig.c, with dials for set-point and compensation, read before the program arms (docs/pil.md). */
#define RIG_DIALLED 1
#include "pil_rig.c" // NOLINT(bugprone-suspicious-include): the same program
