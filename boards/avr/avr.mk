# avr.mk: settings shared by the boards of this family; boards/cortexm/cortexm.mk explains the variables. Memory is small:
# each suite and each scene has its own image (BOARD_IMAGES := single, mk/single.mk); the board's too_large.txt lists those
# that do not fit. The linker script is the compiler's own. A board sets the size of its memories:
#
#     BOARD_MCU      the chip's name, for compiler and emulator
#     BOARD_FLASH    bytes of flash
#     BOARD_RAM      bytes of RAM
#     BOARD_STACK    bytes of RAM that the stack must have
$(call board_needs,BOARD_MCU BOARD_FLASH BOARD_RAM BOARD_STACK BOARD_SECONDS,: it stands before the include of boards/avr/avr.mk)
BOARD_IMAGES   := single
BOARD_DEPS     := avr
BOARD_CROSS    := avr-
BOARD_CC       := $(BOARD_CROSS)gcc
BOARD_NM       := $(BOARD_CROSS)nm
BOARD_SIZE     := $(BOARD_CROSS)size
BOARD_OBJCOPY  := $(BOARD_CROSS)objcopy
BOARD_OBJDUMP  := $(BOARD_CROSS)objdump
BOARD_CPU      := -mmcu=$(BOARD_MCU)
# gcc 5 wrongly warns that arrays are uninitialized if a loop fills them up to a count. If such a loop is unrolled, gcc 5
# also takes passes that never run for stores beyond the array.
BOARD_CFLAGS   := $(BOARD_CPU) -DF_CPU=16000000UL -std=c11 -Os -ffp-contract=off -ffreestanding \
                  -ffunction-sections -fdata-sections -Wno-maybe-uninitialized -Wno-array-bounds \
                  -Iboards/$(BOARD) -I.
BOARD_LDFLAGS  := $(BOARD_CPU) -Wl,--gc-sections \
                  -Wl,--defsym=__TEXT_REGION_LENGTH__=$(BOARD_FLASH) \
                  -Wl,--defsym=__DATA_REGION_LENGTH__=$(BOARD_RAM)-$(BOARD_STACK)
BOARD_LDLIBS   :=
BOARD_TIDY     := --target=avr $(BOARD_CPU) -ffreestanding -DF_CPU=16000000UL -isystem /usr/lib/avr/include -Iboards/$(BOARD)
BOARD_SOURCES  := boards/avr/startup.c boards/avr/board.c boards/avr/clock.c boards/avr/stack.c boards/shared/wait.c
BOARD_EMULATOR := build/avr_run
BOARD_RUN_BY   := $(BOARD_EMULATOR)
BOARD_EMULATE   = sh tests/limit.sh $(BOARD_SECONDS) $(BOARD_EMULATOR) mcu=$(BOARD_MCU) hz=16000000 $(1) </dev/null
