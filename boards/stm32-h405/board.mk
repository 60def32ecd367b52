# stm32-h405: Olimex STM32-H405, STM32F405RG with an 8 MHz crystal. The emulator runs it as a Netduino Plus 2.
BOARD_SECONDS  := 600
BOARD_WHEN     := all
include boards/stm32f4/stm32f4.mk
