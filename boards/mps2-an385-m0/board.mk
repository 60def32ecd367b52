# mps2-an385-m0: code for a Cortex-M0 on the emulated Cortex-M3 of application note 385, which runs all of its instructions.
# Unlike this Cortex-M3, a real Cortex-M0 has no memory protection unit, and faults on words that are not aligned.
BOARD_MACHINE  := mps2-an385
BOARD_CPU      := -mcpu=cortex-m0 -mthumb
BOARD_MATH     :=
BOARD_SECONDS  := 1800
BOARD_TIMING   := m0
BOARD_WHEN     := all
include boards/cortexm/cortexm.mk
BOARD_SOURCES  += boards/shared/convert.c
