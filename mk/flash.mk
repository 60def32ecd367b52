# flash.mk: flashing a board, and a debugger on it. Both print the command that they run.
PROBE ?= stlink
PROBES := stlink cmsis-dap dfu
# The program to flash: the rig with its console; its control software, with the plant at the other end of the line
# (`whirl pil --port`); or first light (firstlight.mk).
PROGRAM ?= station
PROGRAMS := station pil_line firstlight
FLASH_IMAGE := $(ELF)/$(PROGRAM).elf

# Only the image's sectors are erased and written, so the stored settings are kept.
OPENOCD_FOR = openocd -f interface/$(PROBE).cfg -f target/stm32f4x.cfg
FLASH_COMMAND = $(if $(filter dfu,$(PROBE)),$(DFU_COMMAND),$(OPENOCD_FOR) -c "program $(FLASH_IMAGE) verify reset exit")
# The loader in the chip's ROM (BOOT0 high at reset, USB) takes plain bytes, in two pieces. The vectors come last, so
# that an incomplete image does not start.
DFU_COMMAND = dfu-util -d 0483:df11 -a 0 -s 0x0800C000 -D $(ELF)/flash_code.bin && \
    dfu-util -d 0483:df11 -a 0 -s 0x08000000:leave -D $(ELF)/flash_vectors.bin
# OpenOCD stops the watchdog while the core is halted (DBG_IWDG_STOP); this command does not (docs/boards.md).
DEBUG_COMMAND = gdb-multiarch $(FLASH_IMAGE) -ex 'target extended-remote | $(OPENOCD_FOR) -c "gdb_port pipe; log_output $(ELF)/openocd.log"' \
    -ex 'monitor mmw 0xE0042008 0 0x1000'

flash_asks = $(if $(BOARD_FLASHED),$(if $(BOARD_FLASHED_BY),$(error $(BOARD) is flashed by $(BOARD_FLASHED_BY): docs/boards.md says how)),$(error $(BOARD) cannot be flashed. Boards that can: $(boards_flashed) (make flash BOARD=$(lastword $(boards_flashed))). "A new board" in docs/boards.md adds one))$(if $(filter $(1),$(PROBE)),,$(error PROBE is '$(PROBE)': one of $(1)))$(if $(filter $(PROGRAMS),$(PROGRAM)),,$(error PROGRAM is '$(PROGRAM)': one of $(PROGRAMS)))

##@ Boards
flash: ## the rig's firmware onto BOARD, by PROBE=stlink, cmsis-dap or dfu (installs what that takes)
	@:$(call flash_asks,$(PROBES))
	@CC="$(CC)" mk/setup/deps.sh host firmware flash
	@$(MAKE) $(PARALLEL) flash-now
flash-now: $(GEN)/.stamp
	@$(MAKE) $(FLASH_IMAGE)
	@$(BOARD_OBJCOPY) -O binary -j .vectors $(FLASH_IMAGE) $(ELF)/flash_vectors.bin
	@$(BOARD_OBJCOPY) -O binary -R .vectors $(FLASH_IMAGE) $(ELF)/flash_code.bin
	@echo '$(subst ','\'',$(FLASH_COMMAND))'
	@$(FLASH_COMMAND)

debug: ## a debugger on BOARD's firmware, by PROBE=stlink or cmsis-dap; halting resets the chip
	@:$(call flash_asks,$(filter-out dfu,$(PROBES)))
	@CC="$(CC)" mk/setup/deps.sh host firmware flash
	@$(MAKE) $(PARALLEL) debug-now
debug-now: $(GEN)/.stamp
	@$(MAKE) $(FLASH_IMAGE)
	@echo '$(subst ','\'',$(DEBUG_COMMAND))'
	@$(DEBUG_COMMAND)
