# mps2-an385: Arm MPS2 with application note 385, Cortex-M3 without FPU: QEMU needs minutes for all scenes.
BOARD_MACHINE  := mps2-an385
BOARD_CPU      := -mcpu=cortex-m3 -mthumb
BOARD_MATH     :=
BOARD_SECONDS  := 900
BOARD_TIMING   := m3
BOARD_WHEN     := check
include boards/cortexm/cortexm.mk
