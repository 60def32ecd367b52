# cortexm.mk: settings shared by the boards of this family. A board.mk sets these variables, and then includes this file:
#
#     BOARD_MACHINE  the board's name in QEMU
#     BOARD_CPU      the flags that name the processor
#     BOARD_MATH     further flags
#     BOARD_SECONDS  processor seconds that the emulator may take for a program
#     BOARD_TIMING   the core whose cycles mk/count/thumb_cycles.h estimates, if any
#     BOARD_SUITES   `none`: the portable suites are too large for the board; may be missing
#     BOARD_WHEN     the target that includes the board: `test`, `check` or `all` (mk/board.mk)
#
# This file sets
#
#     BOARD_DEPS     the folder of boards/ whose packages.sh names the family's tools
#     BOARD_CC       the compiler; BOARD_NM, BOARD_SIZE, BOARD_OBJCOPY, BOARD_OBJDUMP: its tools
#     BOARD_CFLAGS   all flags for compiling (BOARD_CPU included), except for warnings
#     BOARD_LDFLAGS  all flags for linking, before the objects
#     BOARD_LDLIBS   flags after the objects
#     BOARD_SOURCES  the board's own code, which every program links
#     BOARD_LINK     the board's hal/link.h, for programs with a remote plant (may be missing)
#     BOARD_TIDY     clang-tidy's flags for these sources
#     BOARD_EMULATOR the emulator's command
#     BOARD_RUN_BY   the emulator's path, if it is built from sources here (missing: it is installed)
#     BOARD_EMULATE  $(call BOARD_EMULATE,program.elf) runs a program within BOARD_SECONDS, with the console on
#                    stdout and the program's exit status; more emulator options may be appended
#     BOARD_SERIAL   $(call BOARD_SERIAL,program.elf) runs a program until it is ended, with the console on a
#                    pseudo-terminal that the emulator names (may be missing)
#
# Another family requires its own inputs and sets the same variables. This file has no rules: its paths are relative to the
# repository's root. A family's family.mk has the rules that do not depend on BOARD: for its tools, its tests' programs and
# its gate.
$(call board_needs,BOARD_MACHINE BOARD_CPU BOARD_SECONDS,: it stands before the include of boards/cortexm/cortexm.mk)
BOARD_DEPS     := cortexm
BOARD_CROSS    := arm-none-eabi-
BOARD_CC       := $(BOARD_CROSS)gcc
BOARD_NM       := $(BOARD_CROSS)nm
BOARD_SIZE     := $(BOARD_CROSS)size
BOARD_OBJCOPY  := $(BOARD_CROSS)objcopy
BOARD_OBJDUMP  := $(BOARD_CROSS)objdump
BOARD_CFLAGS   := $(BOARD_CPU) -std=c11 -O2 -ffp-contract=off $(BOARD_MATH) -ffreestanding \
                  -ffunction-sections -fdata-sections -fstack-usage -fcallgraph-info=su \
                  -Iboards/$(BOARD) -I.
BOARD_LDFLAGS  := $(BOARD_CPU) -nostdlib -Tboards/$(BOARD)/board.ld -L. -Wl,--gc-sections \
                  -Wl,--fatal-warnings
BOARD_LDLIBS   := -lgcc
BOARD_TIDY     := --target=arm-none-eabi $(filter -mcpu=%,$(BOARD_CPU)) -ffreestanding -Iboards/$(BOARD)
BOARD_SOURCES  := boards/cortexm/startup.c boards/cortexm/guard.c boards/cortexm/board.c \
                  boards/cortexm/fault.c boards/cortexm/fault_words.c boards/cortexm/demo.c boards/cortexm/cmsdk.c boards/shared/mem.c boards/shared/stack.c \
                  boards/shared/wait.c
BOARD_LINK     := boards/cortexm/link.c
BOARD_EMULATOR := qemu-system-arm
BOARD_EMULATE   = sh tests/limit.sh $(BOARD_SECONDS) $(BOARD_EMULATOR) -M $(BOARD_MACHINE) -nographic \
                  -semihosting-config enable=on,target=native -kernel $(1) </dev/null
BOARD_SERIAL    = $(BOARD_EMULATOR) -M $(BOARD_MACHINE) -display none -monitor none -serial pty \
                  -semihosting-config enable=on,target=native -kernel $(1)
