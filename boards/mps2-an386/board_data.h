/* MPS2 with application note 386, Cortex-M4 with FPU. */
#ifndef BOARD_DATA_H
#define BOARD_DATA_H

#define BOARD_NAME "mps2-an386"
#include "boards/cortexm/mps2.h"

#endif
