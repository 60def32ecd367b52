# atmega2560: Microchip's ATmega2560, emulated by simavr, at 16 MHz.
BOARD_MCU      := atmega2560
BOARD_FLASH    := 256K
BOARD_RAM      := 8K
BOARD_STACK    := 1K
BOARD_SECONDS  := 1800
BOARD_WHEN     := all
include boards/atmega/atmega.mk
