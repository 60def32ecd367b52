# mps2-an385: Arm MPS2 with application note 385, Cortex-M3 without FPU. boards/mps2-an386/board.mk says
# what the variables are.
BOARD_CROSS    := arm-none-eabi-
BOARD_CC       := $(BOARD_CROSS)gcc
BOARD_NM       := $(BOARD_CROSS)nm
BOARD_SIZE     := $(BOARD_CROSS)size
BOARD_OBJCOPY  := $(BOARD_CROSS)objcopy
BOARD_OBJDUMP  := $(BOARD_CROSS)objdump
BOARD_CPU      := -mcpu=cortex-m3 -mthumb
BOARD_CFLAGS   := $(BOARD_CPU) -std=c11 -O2 -ffp-contract=off -ffreestanding \
                  -ffunction-sections -fdata-sections -fstack-usage -fcallgraph-info=su \
                  -Iboards/mps2-an385 -I.
BOARD_LDFLAGS  := $(BOARD_CPU) -nostdlib -Tboards/mps2-an385/board.ld -L. -Wl,--gc-sections \
                  -Wl,--fatal-warnings
BOARD_LDLIBS   := -lgcc
BOARD_SOURCES  := boards/cortexm/startup.c boards/cortexm/board.c boards/cortexm/fault.c \
                  boards/cortexm/cmsdk.c boards/cortexm/mem.c core/text.c
BOARD_MACHINE  := mps2-an385
BOARD_EMULATE   = timeout 900 qemu-system-arm -M $(BOARD_MACHINE) -nographic \
                  -semihosting-config enable=on,target=native -kernel $(1) </dev/null
