/* QEMU's machine virt with an RV32IMAFC. */
#ifndef BOARD_DATA_H
#define BOARD_DATA_H

#define BOARD_NAME "rv32imafc"
#include "boards/riscv/virt.h"

#endif
