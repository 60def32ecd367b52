# rv32imafc: QEMU's machine `virt` as an RV32IMAFC, with single-precision FPU.
BOARD_MACHINE  := virt
BOARD_CPU      := -march=rv32imafc -mabi=ilp32f -misa-spec=2.2
BOARD_MATH     := -fno-math-errno
BOARD_SECONDS  := 600
BOARD_WHEN     := check
include boards/riscv/riscv.mk
