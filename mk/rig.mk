# rig.mk: cost of the rig's controller, and its measurement with noise.

# Largest number of instructions of a control step on BOARD.
RIG_STEP_MOST ?= 1500
# The named board, if any. Without one, the firmware runs as a program of this machine.
ASKED_BOARD := $(if $(filter command environment,$(firstword $(origin BOARD))),$(BOARD))
# If the flashed image is optimised as a whole, steps are counted in that form; only the counting program is not
# optimised with it.
RIG_STEPS_AS := $(if $(filter -flto,$(BOARD_FLASHED_FLAGS)),$(FLASHED),$(BOARD))
$(B)/rig_steps: $(call objects,float,boards/programs/rig_steps.c boards/host/board.c) $(call libraries,float,whirl rig virtual scenes)
	$(link)
$(ELF)/rig_steps.elf: $(call objects,$(RIG_STEPS_AS),boards/programs/rig_steps.c $(BOARD_SOURCES) $(GEN)/rig_observed.c $(GEN)/rig_fixed.c) \
    $(call libraries,$(RIG_STEPS_AS),whirl rig virtual)
	$(link_board)
ifneq ($(RIG_STEPS_AS),$(BOARD))
$(B)/$(FLASHED)/boards/programs/rig_steps.o: FILE_FLAGS += -fno-lto
$(ELF)/rig_steps.elf: BOARD_LDFLAGS := $(BOARD_FLASHED_LDFLAGS)
endif

rig-now:
	$(staged)
ifeq ($(ASKED_BOARD),)
	@$(MAKE) $(B)/station
	@exec $(B)/station
else
	@[ -n "$(BOARD_SERIAL)" ] || { echo "make: the emulator of $(BOARD) is not known to give a serial line" >&2; exit 2; }
	@$(call need,$(BOARD_EMULATOR))
	@$(MAKE) $(STATION)
	@exec $(call BOARD_SERIAL,$(STATION))
endif

rig-steps-now: $(GEN)/.stamp
	@$(MAKE) $(ELF)/rig_steps.elf $(PLUGIN)
	@BOARD=$(BOARD) CC=$(BOARD_CC) NM=$(BOARD_NM) PLUGIN=$(PLUGIN) TIMING=$(BOARD_TIMING) \
	    EMULATE="$(subst limit.sh $(BOARD_SECONDS),limit.sh 900,$(call emulate,$(ELF)/rig_steps.elf))" \
	    mk/count/rig_steps.sh $(ELF)/rig_steps.elf $(RIG_STEP_MOST)

# The measurement against the truth, and its intervals against 1,000 noisy runs of each kind.
rig-truth-now: $(GEN)/.stamp
	@$(MAKE) build/tests/host
	@WHIRL_FULL=1 build/tests/host lockin_truth slope_truth repeats_truth

# Runs with faults in the plant and on the links of the rig's firmware, on this machine or in the emulator of BOARD.
RUNS ?= $(if $(ASKED_BOARD),2000,20000)
FAULTS_OUT := build/faults$(addprefix _,$(ASKED_BOARD)).md
faults-now: $(GEN)/.stamp
	@$(MAKE) build/tools/faults $(if $(ASKED_BOARD),$(ELF)/pil_dialled.elf,$(B)/pil_dialled)
	@build/tools/faults --firmware $(if $(ASKED_BOARD),$(ELF)/pil_dialled.elf --board $(BOARD),$(B)/pil_dialled) \
	    --runs $(RUNS) --seed $(SEED) >$(FAULTS_OUT); code=$$?; cat $(FAULTS_OUT); exit $$code

##@ Tests and quality
# The same firmware on a bench that was written from docs/dev/pil.md alone.
rig-bench: $(B)/tools/rig_bench $(B)/pil_dialled $(B)/pil_swing ##- the rig's firmware against a bench written from docs/dev/pil.md alone: SEED (ten minutes)
	@code=0; for campaign in bench healthy stuck runouts; do build/tools/rig_bench $$campaign --seed $(SEED) || code=1; done; exit $$code

# Telemetry over a line of 115,200, 57,600 and 9,600 baud, in simulated time: every sample arrives or is counted as lost.
TEL_SECONDS ?= 3600
tel-hour: $(B)/whirl $(B)/station $(B)/tools/sim_station $(B)/tools/tel_check ##- an hour of telemetry at three speeds of the line, simulated (minutes; TEL_SECONDS=n)
	@WHIRL=$(B)/whirl TEL_SECONDS=$(TEL_SECONDS) sh tests/cli/monitor.sh
