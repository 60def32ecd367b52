# mps2-an505: Arm MPS2 with application note 505, Cortex-M33 with single-precision FPU, in its secure state.
BOARD_MACHINE  := mps2-an505
BOARD_CPU      := -mcpu=cortex-m33 -mthumb -mfpu=fpv5-sp-d16 -mfloat-abi=hard
BOARD_MATH     := -fno-math-errno
BOARD_SECONDS  := 600
BOARD_WHEN     := check
include boards/armv8m/armv8m.mk
