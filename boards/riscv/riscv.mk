# riscv.mk: settings shared by the boards of this family; boards/cortexm/cortexm.mk explains the variables. The C library is
# picolibc, which only the test image uses. Debian's compiler is named after 64 bits and supports 32, too.
$(call board_needs,BOARD_MACHINE BOARD_CPU BOARD_SECONDS,: it stands before the include of boards/riscv/riscv.mk)
BOARD_DEPS     := riscv
BOARD_CROSS    := riscv64-unknown-elf-
BOARD_CC       := $(BOARD_CROSS)gcc
BOARD_NM       := $(BOARD_CROSS)nm
BOARD_SIZE     := $(BOARD_CROSS)size
BOARD_OBJCOPY  := $(BOARD_CROSS)objcopy
BOARD_OBJDUMP  := $(BOARD_CROSS)objdump
BOARD_CFLAGS   := $(BOARD_CPU) -mcmodel=medany --specs=picolibc.specs -std=c11 -O2 -ffp-contract=off $(BOARD_MATH) \
                  -ffreestanding -ffunction-sections -fdata-sections -fstack-usage -fcallgraph-info=su \
                  -Iboards/$(BOARD) -I.
BOARD_LDFLAGS  := $(BOARD_CPU) --specs=picolibc.specs -nostdlib -Wl,-e,board_entry -Tboards/$(BOARD)/board.ld -L. -Wl,--gc-sections \
                  -Wl,--fatal-warnings
BOARD_LDLIBS   := -lgcc
BOARD_TIDY     := --target=riscv32-unknown-elf $(filter -march=% -mabi=%,$(BOARD_CPU)) -ffreestanding -Iboards/$(BOARD)
BOARD_SOURCES  := boards/riscv/startup.c boards/riscv/guard.c boards/riscv/board.c boards/riscv/fault.c \
                  boards/shared/convert.c boards/shared/mem.c boards/shared/stack.c boards/shared/wait.c
BOARD_EMULATOR := qemu-system-riscv32
BOARD_EMULATE   = sh tests/limit.sh $(BOARD_SECONDS) $(BOARD_EMULATOR) -M $(BOARD_MACHINE) -nographic -bios none \
                  -kernel $(1) </dev/null
