/* MPS2 with application note 500, Cortex-M7. */
#ifndef BOARD_DATA_H
#define BOARD_DATA_H

#define BOARD_NAME "mps2-an500"
#include "boards/cortexm/mps2.h"

#endif
