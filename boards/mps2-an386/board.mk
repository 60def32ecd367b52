# mps2-an386: Arm MPS2 with application note 386, Cortex-M4 with single-precision FPU.
# -fno-math-errno lets a square root be the instruction (core/root.h); the bits are the same without it.
BOARD_MACHINE  := mps2-an386
BOARD_CPU      := -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard
BOARD_MATH     := -fno-math-errno
BOARD_SECONDS  := 600
BOARD_TIMING   := m4
BOARD_WHEN     := test
include boards/cortexm/cortexm.mk
