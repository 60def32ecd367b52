/* pil_rig.c: the rig's firmware (rig.c) on simulated hardware, for `whirl pil` (docs/pil.md). Only the HAL differs. */
#define HAL_VIRTUAL 0
#define HAL_FRAMES 1
#include "rig.c" // NOLINT(bugprone-suspicious-include): the same program
