# mps2-an500: Arm MPS2 with application note 500, Cortex-M7. Its FPU could compute in double, too. The code is compiled for
# single precision, so any double arithmetic is a call of a library, which `make gate-firmware` finds.
BOARD_MACHINE  := mps2-an500
BOARD_CPU      := -mcpu=cortex-m7 -mthumb -mfpu=fpv5-sp-d16 -mfloat-abi=hard
BOARD_MATH     := -fno-math-errno
BOARD_SECONDS  := 600
BOARD_WHEN     := all
include boards/cortexm/cortexm.mk
