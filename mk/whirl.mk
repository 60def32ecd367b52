# whirl.mk: the program, the models built into it, and the scenes it generates.

MODELS := $(sort $(wildcard core/models/*.whirl))


# --- libraries ----------------------------------------------------------------------------------
# Archives, so that a program takes only what it calls. The double build's exported names carry a
# suffix (core/real.h), so one program may hold both.
LIB_FLOAT := $(B)/float/libwhirl.a
LIB_DOUBLE := $(B)/double/libwhirl.a
LIB_HOST := $(B)/host/libwhirl.a

$(LIB_FLOAT): $(call objects,float,$(CORE_C) $(HAL_C))
	$(archive)

$(LIB_DOUBLE): $(call objects,double,$(CORE_C))
	$(archive)

$(LIB_HOST): $(call objects,host,$(WHIRL_C) $(GEN)/builtin_models.c)
	$(archive)

# --- the program --------------------------------------------------------------------------------
# The libraries of the host first: they call the two cores.
$(B)/whirl: $(call objects,host,$(WHIRL_MAIN_C)) $(LIB_HOST) $(LIB_FLOAT) $(LIB_DOUBLE)
	$(link)

# --- built-in models ----------------------------------------------------------------------------
# Follows the list of models too: a model taken away must leave the program.
$(GEN)/models.list: FORCE
	@mkdir -p $(@D)
	@echo '$(MODELS)' | cmp -s - $@ || echo '$(MODELS)' >$@

$(GEN)/builtin_models.c: mk/setup/embed_models.sh $(GEN)/models.list $(MODELS)
	$(say) GEN $@
	$(Q)sh $< $(MODELS) >$@

# --- generated scenes ---------------------------------------------------------------------------
# build/gen/scenes.c, scenes.h and one C file a built-in scene. Only the main configuration makes
# them; the gates compile the same files with other compilers and flags. Files that come out as they
# were are left alone, so that a change in the program does not compile every scene anew.
ifeq ($(B),build)
$(GEN)/.stamp: build/whirl $(MODELS) mk/setup/update_files.sh
	$(say) GEN "$(GEN)/*.c (scenes)"
	$(Q)rm -rf build/gen.new && mkdir build/gen.new && build/whirl emit-scenes build/gen.new
	$(Q)sh mk/setup/update_files.sh build/gen.new $(GEN) builtin_models.c
	@touch $@
endif

# Known only once they are made: what needs them is built by a make of its own, after .stamp.
SCENE_C = $(filter-out $(GEN)/builtin_models.c,$(sort $(wildcard $(GEN)/*.c)))
LIB_SCENES := $(B)/float/libscenes.a
LIB_SCENES_DOUBLE := $(B)/double/libscenes.a

$(LIB_SCENES): $(call objects,float,$(SCENE_C))
	$(archive)

$(LIB_SCENES_DOUBLE): $(call objects,double,$(SCENE_C))
	$(archive)

$(B)/scenes: $(call objects,float,boards/programs/scenes.c boards/host/board.c) $(LIB_SCENES) $(LIB_FLOAT)
	$(link)

# --- make run -----------------------------------------------------------------------------------
.PHONY: run-now
run-now: build/whirl
	@$(MAKE) $(GEN)/.stamp
	@$(MAKE) $(ELF)/scenes.elf $(ELF)/firmware.elf
	@sh mk/demo/run.sh build/whirl $(ELF)/scenes.elf $(ELF)/firmware.elf \
	    '$(call BOARD_EMULATE,IMAGE)'
