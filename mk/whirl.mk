# whirl.mk: the program, the models built into it, and the scenes it generates.

MODELS := $(sort $(wildcard core/models/*.whirl))

# --- libraries ----------------------------------------------------------------------------------
# Libraries of each build of the portable code:
#   libwhirl    the core, all that a scene needs
#   librig      the rig's controller
#   libstation  its console
#   libvirtual  the rig's hardware, played by a scene
#   libframes   hardware at the other end of a line
#   libscenes   the generated scenes
# They are archives, so a program links only the parts that it calls. Exported names of the double build have a suffix
# (core/real.h), so a program may contain both builds.
libraries = $(patsubst %,$(B)/$(1)/lib%.a,$(2))

define portable_libraries
$(call library,$(B)/$(1)/libwhirl.a,$(call objects,$(1),$(CORE_C)))
$(call library,$(B)/$(1)/librig.a,$(call objects,$(1),$(RIG_C)))
$(call library,$(B)/$(1)/libstation.a,$(call objects,$(1),$(STATION_C)))
$(call library,$(B)/$(1)/libvirtual.a,$(call objects,$(1),$(VIRTUAL_C)))
$(call library,$(B)/$(1)/libframes.a,$(call objects,$(1),$(FRAMES_C)))
$(call scenes_library,$(B)/$(1)/libscenes.a,$(1))
endef

# The list of scenes is known only after the scenes are made. A target that needs their library has them made first; a
# second make, which reads the folder again, builds the library.
ifdef SCENES_ARE_MADE
scenes_library = $(call library,$(1),$(call objects,$(2),$(SCENE_C)))
else
define scenes_library
$(1): $(GEN)/.stamp FORCE
	@$$(MAKE) SCENES_ARE_MADE=1 $$@
endef
endif
SCENE_C = $(filter-out $(GEN)/builtin_models.c,$(sort $(wildcard $(GEN)/*.c)))
$(foreach b,float double,$(eval $(call portable_libraries,$(b))))

LIB_FLOAT := $(call libraries,float,whirl)
LIB_DOUBLE := $(call libraries,double,whirl)
LIB_HOST := $(B)/host/libwhirl.a

$(eval $(call library,$(LIB_HOST),$(call objects,host,$(WHIRL_C) $(GEN)/builtin_models.c)))

# --- the program --------------------------------------------------------------------------------
# The host's libraries come first, because they call the two cores.
$(B)/whirl: $(call objects,host,$(WHIRL_MAIN_C)) $(LIB_HOST) $(LIB_FLOAT) $(LIB_DOUBLE)
	$(link)

# --- built-in models ----------------------------------------------------------------------------
# A change of the list of models also renews the file: a removed model must leave the program.
$(eval $(call listed,$(GEN)/models.list,$(MODELS) $(sort $(wildcard mk/figures/*.fig))))

FIGURE_TEXTS := $(sort $(wildcard mk/figures/*.fig))
$(GEN)/builtin_models.c: mk/setup/embed_models.sh $(GEN)/models.list $(MODELS) $(FIGURE_TEXTS)
	$(say) GEN $@
	$(Q)sh $< $(MODELS) -- $(FIGURE_TEXTS) >$@

# --- generated scenes ---------------------------------------------------------------------------
# build/gen has scenes.c, scenes.h and one C file per built-in scene. Only the main configuration makes them; the gates
# compile the same files with other compilers and flags. Unchanged files are not touched, so that a change of the
# program does not compile every scene again.
#
# The rig's observer uses the same model. It makes one step a control step and is corrected twice a turn. The error of a
# second-order step over a turn is 1e-4 rad there.
RIG_OBSERVED := --step 2ms --method heun
ifeq ($(B),build)
$(GEN)/.stamp: build/whirl $(MODELS) mk/setup/update_files.sh
	$(say) GEN "$(GEN)/*.c (scenes)"
	$(Q)rm -rf build/gen.new && mkdir build/gen.new && build/whirl emit-scenes build/gen.new
	$(Q)build/whirl derive rig_fixed --as c $(RIG_OBSERVED) --name rig_observed >build/gen.new/rig_observed.c
	$(Q)sh mk/setup/update_files.sh build/gen.new $(GEN) builtin_models.c
	@touch $@
else
$(GEN)/.stamp: # if it is missing, the main configuration makes it, without this one's settings
	@env -i PATH="$$PATH" $(MAKE_COMMAND) $@
endif

# The objects that include the scenes' headers.
$(foreach b,host float double $(BOARD),$(patsubst %,$(B)/$(b)/%.o,boards/programs/size \
    $(addprefix tests/core/,compensated_rotor test_rig_bounds test_rig_observed test_rig_observer test_scenes))): \
    | $(GEN)/.stamp

define staged
	$(call stage,1 of 2: the program$(comma) and the built-in scenes as C)
	+@$(MAKE) $(GEN)/.stamp
	$(call stage,2 of 2: the firmware with all scenes$(comma) some minutes the first time)
endef

# --- make run -----------------------------------------------------------------------------------
# The third image is for the commands of README.md.
RUN_IMAGES = $(addprefix $(ELF)/,scenes.elf firmware.elf pil_rig.elf)
run-now:
	$(staged)
	@$(MAKE) $(RUN_IMAGES)
	@[ ! -t 1 ] || printf "\033[K"
	@sh mk/demo/run.sh build/whirl $(ELF)/scenes.elf $(ELF)/firmware.elf \
	    '$(call BOARD_EMULATE,IMAGE)'
