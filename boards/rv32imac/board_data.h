/* QEMU's machine virt with an RV32IMAC. */
#ifndef BOARD_DATA_H
#define BOARD_DATA_H

#define BOARD_NAME "rv32imac"
#include "boards/riscv/virt.h"

#endif
