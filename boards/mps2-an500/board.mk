# mps2-an500: Arm MPS2 with application note 500, Cortex-M7. Its FPU could do double as well; compiled for single
# precision, any double arithmetic would show as a call of a library (make gate-firmware).
BOARD_MACHINE  := mps2-an500
BOARD_CPU      := -mcpu=cortex-m7 -mthumb -mfpu=fpv5-sp-d16 -mfloat-abi=hard
BOARD_MATH     := -fno-math-errno
BOARD_SECONDS  := 600
BOARD_WHEN     := all
BOARD_WATCHDOG := boards/cortexm/cmsdk_watchdog.c
include boards/cortexm/cortexm.mk
