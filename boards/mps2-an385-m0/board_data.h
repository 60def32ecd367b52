/* MPS2 with application note 385, code for a Cortex-M0. */
#ifndef BOARD_DATA_H
#define BOARD_DATA_H

#define BOARD_NAME "mps2-an385-m0"
#include "boards/cortexm/mps2.h"

#endif
