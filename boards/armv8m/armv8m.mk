# armv8m.mk: boards with a Cortex-M of Armv8-M share all of boards/cortexm except the stack guard.
include boards/cortexm/cortexm.mk
BOARD_SOURCES := $(filter-out boards/cortexm/guard.c,$(BOARD_SOURCES)) boards/armv8m/guard.c
