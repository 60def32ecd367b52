/* pil_swing.c: pil_rig.c, with a free swing at the run's end, which gives the sensors' positions (docs/rig.md). */
#define RIG_SWINGS 1
#include "pil_rig.c" // NOLINT(bugprone-suspicious-include): the same program
