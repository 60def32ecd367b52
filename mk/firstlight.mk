# firstlight.mk: first light of a board (boards/programs/firstlight.c, docs/firstlight.md): the scenes' hashes, cycles
# and a self-test in one record. The motor is never enabled.

# On a board with hardware, first light uses that hardware, compiled as in other programs: its cycles are those of
# `make bench`.
LIGHT := $(ELF)/firstlight.elf
LIGHT_AS := $(if $(filter -flto,$(BOARD_FLASHED_FLAGS)),$(BOARD),$(FLASHED))
LIGHT_SCENES := $(patsubst %,$(GEN)/%.c,$(shell sed -n 's/^    X(\([a-z_]*\)).*/\1/p' core/light_fields.h))
LIGHT_C := boards/programs/firstlight.c $(LIGHT_SCENES)
LIGHT_BOARD := $(if $(BOARD_FLASHED),$(BOARD_FLASHED) $(GEN)/rig_observed.c,$(BOARD_SOURCES))
$(foreach b,float $(LIGHT_AS),$(B)/$(b)/boards/programs/firstlight.o): | $(GEN)/.stamp
$(B)/firstlight: $(call objects,float,$(LIGHT_C) boards/host/board.c) $(call libraries,float,whirl)
	$(link)
$(LIGHT): $(call objects,$(LIGHT_AS),$(LIGHT_C) $(LIGHT_BOARD)) $(call libraries,$(LIGHT_AS),station rig whirl)
	$(link_board)
ifneq ($(BOARD_FLASHED),)
$(B)/$(LIGHT_AS)/boards/programs/firstlight.o: private FILE_FLAGS = -DLIGHT_HARDWARE=1
endif
ifneq ($(LIGHT_AS),$(BOARD))
$(LIGHT): BOARD_LDFLAGS := $(BOARD_FLASHED_LDFLAGS)
endif

LIGHT_FITS := $(if $(shell grep -sxh 'program firstlight' $(TOO_LARGE) /dev/null),,yes)
LIGHT_IMAGE := $(if $(LIGHT_FITS),$(LIGHT))
LIGHT_RECORD := $(ELF)/firstlight.txt
# An emulated board with hardware lacks the converter and the stop line: it can show only the scenes' hashes.
LIGHT_CHECK = build/whirl firstlight $(LIGHT_RECORD) --board $(BOARD)
LIGHT_FLASH = $(if $(BOARD_FLASHED_BY),by $(BOARD_FLASHED_BY) (docs/boards.md): $(LIGHT),make flash BOARD=$(BOARD) PROGRAM=firstlight PROBE=stlink)

##@ Boards
firstlight: ## first light of BOARD: the image, its record in the emulator, and the commands for silicon (docs/firstlight.md)
	@CC="$(CC)" mk/setup/deps.sh host $(BOARD_DEPS)
	@$(MAKE) $(PARALLEL) firstlight-now
firstlight-record: $(LIGHT) $(BOARD_RUN_BY)
	@$(call need,$(BOARD_EMULATOR))
	@sh mk/demo/firstlight.sh $(LIGHT_RECORD) '$(call emulate,$(LIGHT))'
firstlight-now: $(GEN)/.stamp
	@:$(if $(LIGHT_FITS),,$(error firstlight is too large for $(BOARD): $(TOO_LARGE)))
	@$(MAKE) build/whirl firstlight-record
ifeq ($(BOARD_FLASHED),)
	@$(LIGHT_CHECK)
else
	@$(LIGHT_CHECK) | { tee $(ELF)/firstlight.said; grep -q '^hashes: \([0-9]*\) of \1 equal' $(ELF)/firstlight.said; }
	@echo
	@echo 'In the emulator. On the board: $(LIGHT_FLASH)'
	@echo 'Then: build/whirl firstlight /dev/ttyUSB0 --board $(BOARD) --emulated $(LIGHT_RECORD)'
endif
