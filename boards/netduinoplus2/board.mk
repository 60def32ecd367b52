# netduinoplus2: Netduino Plus 2, STM32F405RG with a 25 MHz crystal. QEMU emulates this board.
BOARD_SECONDS  := 600
BOARD_WHEN     := all
include boards/stm32f4/stm32f4.mk
