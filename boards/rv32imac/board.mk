# rv32imac: QEMU's machine `virt` as an RV32IMAC, without FPU: all scenes take QEMU minutes.
BOARD_MACHINE  := virt
BOARD_CPU      := -march=rv32imac -mabi=ilp32 -misa-spec=2.2
BOARD_MATH     :=
BOARD_SECONDS  := 900
BOARD_WHEN     := all
include boards/riscv/riscv.mk
