# mps2-an386: Arm MPS2 with application note 386, Cortex-M4 with single-precision FPU.
#
# Every board.mk sets the same variables and holds no rules; paths are from the repository's root:
#   BOARD_CC       compiler; BOARD_NM, BOARD_SIZE, BOARD_OBJCOPY, BOARD_OBJDUMP its tools
#   BOARD_CPU      the flags that name the machine
#   BOARD_CFLAGS   everything for compiling (BOARD_CPU included), warnings excepted
#   BOARD_LDFLAGS  everything for linking, before the objects
#   BOARD_LDLIBS   after the objects
#   BOARD_SOURCES  the board's own code, to be linked with every program
#   BOARD_EMULATE  $(call BOARD_EMULATE,program.elf) runs it for a minute or so at most; console on stdout,
#                  exit status the program's; more emulator options may be appended
# -fno-math-errno lets a square root be the instruction (core/root.h); the bits are the same without it.
BOARD_CROSS    := arm-none-eabi-
BOARD_CC       := $(BOARD_CROSS)gcc
BOARD_NM       := $(BOARD_CROSS)nm
BOARD_SIZE     := $(BOARD_CROSS)size
BOARD_OBJCOPY  := $(BOARD_CROSS)objcopy
BOARD_OBJDUMP  := $(BOARD_CROSS)objdump
BOARD_CPU      := -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard
BOARD_CFLAGS   := $(BOARD_CPU) -std=c11 -O2 -ffp-contract=off -fno-math-errno -ffreestanding \
                  -ffunction-sections -fdata-sections -fstack-usage -fcallgraph-info=su \
                  -Iboards/mps2-an386 -I.
BOARD_LDFLAGS  := $(BOARD_CPU) -nostdlib -Tboards/mps2-an386/board.ld -L. -Wl,--gc-sections \
                  -Wl,--fatal-warnings
BOARD_LDLIBS   := -lgcc
BOARD_SOURCES  := boards/cortexm/startup.c boards/cortexm/board.c boards/cortexm/fault.c \
                  boards/cortexm/cmsdk.c boards/cortexm/mem.c core/text.c
BOARD_MACHINE  := mps2-an386
BOARD_EMULATE   = timeout 60 qemu-system-arm -M $(BOARD_MACHINE) -nographic \
                  -semihosting-config enable=on,target=native -kernel $(1) </dev/null
