# hard.mk: compares the bits of the hard cases of docs/hard (docs/hard_cases.md) on all hosts and boards: fast
# rotation, whole turns far from zero, resonance and the passage through it, dead centres, subnormal numbers and
# others. Each case has few steps, so that slow boards can take part.

# FILE:SCENE of docs/hard. Options of `whirl derive` follow as :+compensated+stabilized. The scene's name is its name
# in the table.
HARD := rotor:rotor_fast rotor:rotor_weighted rotor:rotor_far rotor:rotor_slow resonance:resonance_grows \
    sommerfeld:shaker_through dead_centre:crank_turns dead_centre:crank_starts polar:polar_passes disc:disc_swings \
    masses:masses_swing stiff_spring:stiff_spring_swings stiff_stop:floor_of_spring stiff_stop:floor_of_stop \
    pulsating_load:load_pulsates moving_floor:hops_end moving_floor:table_falls_away redundant:beam_lifts \
    redundant:blocks_slide cradle:cradle_swings jump:jump_inside scales:scales_least scales:scales_subnormal \
    scales:scales_most long:gear_turns:+compensated+stabilized
HARD_UNTIL := 0.8s
HARD_IN := build/hard
hard_names := $(foreach s,$(HARD),$(word 2,$(subst :, ,$(s))))
HARD_C := $(patsubst %,$(HARD_IN)/%.c,scenes $(hard_names))

# hard_scene FILE SCENE OPTIONS
define hard_scene
$(HARD_IN)/$(2).c: docs/hard/$(1).whirl build/whirl mk/hard.mk
	@mkdir -p $$(@D)
	$$(say) GEN $$@
	$$(Q)build/whirl derive $$<:$(2) --as c --until $(HARD_UNTIL) $(subst +, --,$(3)) --header $$(@:.c=.h) >$$@
endef
$(foreach s,$(HARD),$(eval $(call hard_scene,$(firstword $(subst :, ,$(s))),$(word 2,$(subst :, ,$(s))),$(word 3,$(subst :, ,$(s))))))
$(HARD_IN)/scenes.c: mk/count/index.sh mk/hard.mk $(hard_names:%=$(HARD_IN)/%.c)
	@mkdir -p $(@D)
	$(say) GEN $@
	$(Q)$< $(hard_names) >$@
.SECONDARY: $(HARD_C)

$(eval $(call program,scenes_hard,boards/programs/scenes.c $(HARD_C),whirl))

ifeq ($(BOARD_IMAGES),single)
hard_elf := $(hard_names:%=$(SINGLE)/hard_%.elf)
$(hard_elf): $(SINGLE)/hard_%.elf: $(B)/$(BOARD)/$(HARD_IN)/%.o $(SCENE_NEEDS)
	$(call scene_link,boards/programs/scenes.c,$(HARD_IN)) $(or_empty)
hard-images: $(hard_elf) $(BOARD_RUN_BY)
print-hard-hashes:
	@$(call print_of,$(hard_elf))
else
hard-images: $(ELF)/scenes_hard.elf
print-hard-hashes: # hashes of the hard cases
	@$(call need,$(BOARD_EMULATOR))
	@$(call emulate,$(ELF)/scenes_hard.elf)
endif

# Compared with the interpreter: this machine's compilers, other processors, boards (or HARD_BOARDS="mps2-an386").
HARD_BUILDS ?= gcc-O0 gcc-O2 clang-O2
HARD_HOSTS ?=
HARD_BOARDS ?= $(BOARDS)
##@ Tests and quality
hashes-hard: build/whirl $(HARD_C) ##- the same bits on every board of the hard cases of docs/hard_cases.md (a minute; HARD_BOARDS="...")
	+@$(MAKE) HASHED=scenes_hard $(addprefix hash-,$(HARD_BUILDS)) $(addprefix hash-host-,$(HARD_HOSTS))
	+@$(foreach b,$(HARD_BOARDS),$(call on_board,$(b),hard-images) &&) true
	@sh tests/hashes.sh build/hash/hard "the interpreter" "sh tests/hard_hashes.sh $(HARD_UNTIL) $(HARD)" \
	    $(foreach h,$(HARD_BUILDS),$(h) $(call hash_folder,$(h))/scenes_hard) \
	    $(foreach h,$(HARD_HOSTS),"$(h)" "$(host_run_$(h)) build/hosts/$(h)/scenes_hard") \
	    $(foreach b,$(HARD_BOARDS),"$(b)" "$(call on_board,$(b),print-hard-hashes)")

guards: build/tests/host ##- takes each guard of a hard case away: does a test fail? (minutes; in a copy of the tree)
	@MAKE="$(MAKE)" sh mk/mutants/guards.sh
