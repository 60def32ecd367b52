# stm32f4.mk: boards with an STM32F405: boards/cortexm, with clocks, console and time base of this chip, and the rig's
# hardware. Programs that end, with an exit status, are for the emulator; a flashed program never ends. Variables for flashed
# images:
#
#     BOARD_FLASHED  the board's code including the rig's hardware, instead of BOARD_SOURCES (may be missing: the
#                    rig's hardware is then simulated)
#     BOARD_FLASHED_FLAGS  flags for less flash: such an image has its own build (mk/board.mk)
#     BOARD_MOST     maximum bytes of flash, and of RAM with the worst stack: `make size` fails beyond
BOARD_MACHINE  := netduinoplus2
BOARD_CPU      := -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard
BOARD_MATH     := -fno-math-errno
include boards/cortexm/cortexm.mk
# These flags save flash, at the cost of some more instructions per control step (`make rig-steps`, gate-flashed: 1,500 at
# most). Link-time optimisation saves 1 kB. No copies of code for speed, and no moves that need more registers, save 1.4 kB.
# With these flags gcc wrongly warns of uninitialized values.
SMALL_BY_LINK  := -Os -g -flto -flto-partition=one -ffat-lto-objects -fno-ipa-cp -fno-early-inlining -fno-reorder-blocks -fno-tree-tail-merge \
                  -fno-thread-jumps -fno-if-conversion -fno-move-loop-invariants -fno-schedule-insns2 -fno-shrink-wrap \
                  -fno-caller-saves -fno-tree-loop-im -fno-hoist-adjacent-loads \
                  --param=max-jump-thread-duplication-stmts=0 --param=gcse-cost-distance-ratio=40
# Packed words save 2 kB; no record of control steps saves 2 kB.
BOARD_FLASHED_FLAGS := $(SMALL_BY_LINK) -DWH_SMALL=1 -Wno-maybe-uninitialized
BOARD_FLASHED_LDFLAGS := $(BOARD_LDFLAGS) $(SMALL_BY_LINK) -fstack-usage -fcallgraph-info=su
# Otherwise semihosting would be in every image.
BOARD_LINK     :=
BOARD_COMMON   := $(filter-out boards/cortexm/cmsdk.c boards/cortexm/demo.c,$(BOARD_SOURCES)) \
                  $(addprefix boards/stm32f4/,clock.c pins.c ring.c time_base.c usart.c)
BOARD_SOURCES  := $(BOARD_COMMON) boards/cortexm/demo.c
BOARD_FLASHED  := $(BOARD_COMMON) boards/cortexm/flashed.c boards/cortexm/kept.c \
                  $(addprefix boards/shared/,remembered.c reset_words.c rig_time.c) \
                  $(addprefix boards/stm32f4/,brown_out.c cell.c flash.c motor.c reset.c rig_clock.c slots.c stop.c watchdog.c)
BOARD_MOST     := FLASH_MOST=65536 RAM_MOST=16384
# The portable suites are larger than the chip's memory: they run on mps2-an386, which has the same processor. The chip's
# drivers have tests of their own (tests/chip, gate-flashed).
BOARD_SUITES   := none
# The console is serial interface 6, which is the emulator's sixth.
BOARD_SERIALS   = -display none -monitor none -serial null -serial null -serial null -serial null -serial null -serial
BOARD_EMULATE   = sh tests/limit.sh $(BOARD_SECONDS) $(BOARD_EMULATOR) -M $(BOARD_MACHINE) $(BOARD_SERIALS) stdio \
                  -semihosting-config enable=on,target=native -kernel $(1) </dev/null
BOARD_SERIAL    = $(BOARD_EMULATOR) -M $(BOARD_MACHINE) $(BOARD_SERIALS) pty -kernel $(1)
