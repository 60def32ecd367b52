# feather-f405: Adafruit Feather STM32F405 Express, with a 12 MHz crystal. The emulator runs it as a Netduino Plus 2.
BOARD_SECONDS  := 600
BOARD_WHEN     := all
include boards/stm32f4/stm32f4.mk
