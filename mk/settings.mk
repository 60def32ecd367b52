# settings.mk: the same bits on every board with every setting of `whirl price` (host/study/trial.h). tests/settings_hashes.sh
# writes some scenes with every setting that they accept, and the interpreter's hashes. The compiled code, on this machine
# and on boards, must print the same hashes.

# Together they have: a matrix, tables, turned and looked-up angles, every method, first order, stops, fixed point.
SETTINGS_WHOLE := two_mass_relative epicyclic_conserved mk/price/separable.whirl \
    tests/boards/settings.whirl:mixed_turns tests/boards/settings.whirl:clapper_claps
# One setting in four of a scene that has the gear's settings, but also an input and gravity.
SETTINGS_PARTS := rig_fixed
SETTINGS_STEPS := 500
# `all` settings, or `some`: one in so many, and each that has a new word, as in the gate hashes.
SETTINGS ?= all
SETTINGS_SCENES_all := $(foreach s,$(SETTINGS_WHOLE),1 $(s)) $(foreach s,$(SETTINGS_PARTS),4 $(s))
SETTINGS_SCENES_some := $(foreach s,$(SETTINGS_WHOLE),$(if $(findstring .whirl,$(s)),11,37) $(s)) \
    $(foreach s,$(SETTINGS_PARTS),37 $(s))
SETTINGS_KINDS ?= float double fixed
SETTINGS_IN := build/settings/$(SETTINGS)

# Files that come out unchanged are not touched.
settings-written: new = $(SETTINGS_IN).new
settings-written: hashed = $$(sed 's/^scene //; s/ .*//' $(1).hashes)
settings-written: build/whirl tests/settings_hashes.sh
	$(say) GEN "$(SETTINGS_IN)/*.c"
	$(Q)rm -rf $(new) && mkdir -p $(new) $(SETTINGS_IN)
	$(Q)sh tests/settings_hashes.sh build/whirl $(new) $(SETTINGS_STEPS) $(SETTINGS_SCENES_$(SETTINGS))
	$(Q)mk/count/index.sh $(call hashed,$(new)/float) >$(new)/table_real.c
	$(Q)mk/count/index.sh --fixed $(call hashed,$(new)/fixed) >$(new)/table_fixed.c
	$(Q)cp $(new)/*.hashes $(SETTINGS_IN)
	$(Q)sh mk/setup/update_files.sh $(new) $(SETTINGS_IN)

# Only the make that runs after these files are written knows which exist.
settings_c_fixed = $(wildcard $(SETTINGS_IN)/*_fixed.c)
settings_c_float = $(filter-out $(settings_c_fixed) $(SETTINGS_IN)/table_%.c,$(wildcard $(SETTINGS_IN)/*.c)) $(SETTINGS_IN)/table_real.c
settings_c_double = $(settings_c_float)
settings_main_float := boards/programs/scenes.c
settings_main_double := $(settings_main_float)
settings_main_fixed := boards/programs/fixed_scenes.c
settings_files = $(settings_main_$(1)) $(settings_c_$(1))

# The boards again, in double.
BOARD_IN_DOUBLE := $(BOARD)/double
$(eval $(call build,$(BOARD_IN_DOUBLE),$(BOARD_CC),$(BOARD_CFLAGS) $(WARN) -DWH_DOUBLE=1 $(BOARD_EXTRA)))
$(eval $(call library,$(B)/$(BOARD_IN_DOUBLE)/libwhirl.a,$(call objects,$(BOARD_IN_DOUBLE),$(CORE_C))))

settings_build_float := float
settings_build_double := double
settings_build_fixed := float
settings_board_float := $(BOARD)
settings_board_double := $(BOARD_IN_DOUBLE)
settings_board_fixed := $(BOARD)

define settings_programs
$(B)/bits/$(SETTINGS)_$(1): $$(call objects,$(settings_build_$(1)),$$(call settings_files,$(1)) boards/host/board.c) \
    $(call libraries,$(settings_build_$(1)),whirl)
	$$(link)
$(ELF)/bits/$(SETTINGS)_$(1).elf: $$(call objects,$(settings_board_$(1)),$$(call settings_files,$(1))) $(BOARD_OBJECTS) \
    $(call libraries,$(settings_board_$(1)),whirl) $(call libraries,$(BOARD),whirl)
	@mkdir -p $$(@D)
	$$(link_board)
endef
$(foreach k,$(SETTINGS_KINDS),$(eval $(call settings_programs,$(k))))

ifneq ($(filter settings-% print-settings,$(MAKECMDGOALS)),)
-include $(wildcard $(foreach b,float double $(BOARD) $(BOARD_IN_DOUBLE),$(B)/$(b)/$(SETTINGS_IN)/*.d))
-include $(wildcard $(B)/$(BOARD_IN_DOUBLE)/core/*.d $(B)/$(BOARD_IN_DOUBLE)/boards/programs/*.d)
endif

settings-programs: $(SETTINGS_KINDS:%=$(B)/bits/$(SETTINGS)_%)

ifeq ($(BOARD_IMAGES),single)
# One image per scene, in float and in fixed point: double is float on these boards.
BITS := $(ELF)/bits/$(SETTINGS)
settings_elf = $(patsubst $(SETTINGS_IN)/%.c,$(BITS)/%.elf,$(filter-out $(SETTINGS_IN)/table_%,$(settings_c_$(1))))
$(BITS)/%.elf: $(B)/$(BOARD)/$(SETTINGS_IN)/%.o $(SCENE_NEEDS)
	$(call scene_link,$(settings_main_$(if $(filter %_fixed,$*),fixed,float)),$(SETTINGS_IN),,$(if $(filter %_fixed,$*),--fixed)) $(or_empty)
settings-images: $(call settings_elf,float) $(call settings_elf,fixed) $(BOARD_RUN_BY)
print-settings:
	@$(call print_of,$(call settings_elf,$(KIND)))
else
settings-images: $(SETTINGS_KINDS:%=$(ELF)/bits/$(SETTINGS)_%.elf)
print-settings: # hashes of the settings of KIND
	@$(call need,$(BOARD_EMULATOR))
	@$(call emulate,$(ELF)/bits/$(SETTINGS)_$(KIND).elf)
endif

# --- all of them beside the interpreter ---------------------------------------------------------------------------------
# This machine's compilers, processors that are no boards of ours (check.mk), and boards. AVR's compiler has no double.
SETTINGS_BUILDS := gcc-O2 clang-O2
SETTINGS_HOSTS ?= $(if $(filter all,$(SETTINGS)),$(HASH_HOSTS))
SETTINGS_BOARDS ?= $(if $(filter all,$(SETTINGS)),$(BOARDS_ALL),$(BOARDS))
settings_boards_float = $(SETTINGS_BOARDS)
settings_boards_fixed = $(SETTINGS_BOARDS)
settings_boards_double = $(filter-out $(BOARDS_SINGLE),$(SETTINGS_BOARDS))
# A board's image holds hundreds of scenes.
settings_on_board = $(call on_board,$(1),SETTINGS=$(SETTINGS) BOARD_SECONDS=3600 KIND=$(2) print-settings)

compare_settings = "In $(1):" "interpreter $(1)" "cat $(SETTINGS_IN)/$(1).hashes" \
    $(foreach h,$(SETTINGS_BUILDS),"$(h) $(1)" $(call hash_folder,$(h))/bits/$(SETTINGS)_$(1)) \
    $(foreach h,$(SETTINGS_HOSTS),"$(h) $(1)" "$(host_run_$(h)) build/hosts/$(h)/bits/$(SETTINGS)_$(1)") \
    $(foreach b,$(settings_boards_$(1)),"$(b) $(1)" "$(call settings_on_board,$(b),$(1))")

##@ Tests and quality
hashes-settings: settings-written ##- the same bits on every board with every setting of six scenes (half an hour; SETTINGS=some SETTINGS_BOARDS="...")
	+@$(MAKE) HASHED=settings-programs $(addprefix hash-,$(SETTINGS_BUILDS)) $(addprefix hash-host-,$(SETTINGS_HOSTS))
	+@$(foreach b,$(SETTINGS_BOARDS),$(call on_board,$(b),SETTINGS=$(SETTINGS) settings-images) &&) true
	@HASH_SECONDS=7200 sh tests/hashes.sh build/hash/settings_$(SETTINGS) $(foreach k,$(SETTINGS_KINDS),-- $(call compare_settings,$(k)))
