/* pil_swing.c: pil_rig.c with a run that ends in a free swing, which gives the sensors' positions (docs/rig.md). */
#define RIG_SWINGS 1
#include "pil_rig.c" // NOLINT(bugprone-suspicious-include): the same program
