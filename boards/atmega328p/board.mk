# atmega328p: Microchip's ATmega328P, emulated by simavr, at 16 MHz.
BOARD_MCU      := atmega328p
BOARD_FLASH    := 32K
BOARD_RAM      := 2K
BOARD_STACK    := 400
BOARD_SECONDS  := 600
BOARD_WHEN     := all
include boards/avr/avr.mk
