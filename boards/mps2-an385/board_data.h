/* MPS2 with application note 385, Cortex-M3. */
#ifndef BOARD_DATA_H
#define BOARD_DATA_H

#define BOARD_NAME "mps2-an385"
#include "boards/cortexm/mps2.h"

#endif
