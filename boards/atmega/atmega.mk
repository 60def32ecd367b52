# atmega.mk: boards with an ATmega2560: boards/avr, with drivers for all of the rig's hardware. Programs that end, with an
# exit status, are for the emulator. A flashed program never ends, and has its own build (BOARD_FLASHED_FLAGS). Its 8 KB of
# memory have no room for telemetry and for samples of slow turns, and 16 MHz are too slow for an observer and a free swing
# (docs/boards.md).
include boards/avr/avr.mk
BOARD_ATMEGA   := $(addprefix boards/atmega/,board.c cell.c eeprom.c fault.c kept.c motor.c reset.c rig_clock.c slots.c stop.c time_base.c \
                  usart.c watchdog.c)
BOARD_FLASHED  := boards/avr/startup.c boards/avr/stack.c \
                  $(addprefix boards/shared/,remembered.c reset_words.c rig_time.c wait.c) $(BOARD_ATMEGA)
BOARD_FLASHED_FLAGS := -DWH_WORDS_FROM=0x2200 -DWH_STATION_TELEMETRY=0 -DWH_RIG_SWINGS=0 -DWH_RIG_COMPENSATES=0 \
                  -DHAL_LOADCELL_PERIOD_TICKS=8000U -DWH_LOCKIN_SAMPLES=64U -DWH_RIG_SMALL_PIECES=1 \
                  -DRIG_SAMPLES_MOST=1U -DRIG_SAMPLES_WITH_PULSE=0U \
                  -DWH_STATION_IN_BYTES=128U -DWH_STATION_OUT_BYTES=512U -DWH_ROOT_BY_BITS=1 -fno-tree-switch-conversion
BOARD_TIDY     += $(filter -D%,$(BOARD_FLASHED_FLAGS))
BOARD_FLASHED_BY := avrdude
BOARD_MOST     := FLASH_MOST=262144 MEMORY_TOP=0x802200
BOARD_SIZE_BY  := boards/avr/size.sh
BOARD_FLASHED_LDFLAGS := $(BOARD_CPU) -Wl,--gc-sections -Wl,--fatal-warnings -Tboards/atmega/atmega2560.ld
