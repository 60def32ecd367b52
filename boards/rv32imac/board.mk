# rv32imac: QEMU's machine `virt` as an RV32IMAC, without FPU: QEMU needs minutes for all scenes.
BOARD_MACHINE  := virt
BOARD_CPU      := -march=rv32imac -mabi=ilp32 -misa-spec=2.2
BOARD_MATH     :=
BOARD_SECONDS  := 900
BOARD_WHEN     := all
include boards/riscv/riscv.mk
