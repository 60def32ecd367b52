# family.mk: tests of flashed images in the emulator (tests/boards/f405.sh). Their code is that of a real board, except for
# the sensors, which the emulator does not have.
ifneq ($(filter boards/stm32f4/%,$(BOARD_FLASHED)),)
# Excluded from link-time optimisation: functions that the compiler itself calls, and the start-up code. main() might be
# inlined into the start-up code, and use variables or the FPU before they are set up. Objects from a compiler cache lack
# their call graphs, from which mk/size/size.sh computes the stack.
apart := $(addprefix $(B)/$(FLASHED)/boards/,shared/mem.o cortexm/startup.o)
$(apart): FILE_FLAGS += -fno-lto
$(apart): export CCACHE_DISABLE := 1

without_sensors = $(filter-out %/cell.o %/slots.o %/stop.o,$(FLASHED_OBJECTS))
$(ELF)/bench_plant.elf: BOARD_LDLIBS += -Wl,--wrap=hal_motor_start -Wl,--wrap=hal_motor_set_voltage -Wl,--wrap=hal_motor_off
$(ELF)/bench_plant.elf: $(call objects,$(FLASHED),boards/programs/station.c tests/boards/f405_plant.c \
    $(GEN)/rig_observed.c $(GEN)/rig_fixed.c) $(without_sensors) $(call libraries,$(FLASHED),station rig virtual whirl)
	$(link_board)
FLASHED_TESTS := $(ELF)/bench_plant.elf
endif
build/tools/f405: $(call objects,host,$(addprefix tests/tools/,board_tests.c f405.c f405_seen.c f405_states.c emulated.c))
	$(link)
