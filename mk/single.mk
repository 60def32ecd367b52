# single.mk: boards with too little memory for whole images have one image for each suite and for each scene.
#
# boards/<board>/too_large.txt lists the programs that do not fit, with lines "suite NAME", "scene NAME" or "program NAME".
# `make too-large` makes that list. `make hashes-all` and `make test-boards` report if it is out of date.

SINGLE := $(ELF)/single
TOO_LARGE := boards/$(BOARD)/too_large.txt
SCENE_NAMES = $(filter-out scenes,$(notdir $(SCENE_C:.c=)))
SUITE_NAMES := $(patsubst test_%,%,$(notdir $(basename $(wildcard tests/core/test_*.c))))

single_link = $(BOARD_CC) $(BOARD_CFLAGS) $(WARN) $(2) $(BOARD_LDFLAGS) -o $@ $(1) $(filter %.o,$^) \
    -Wl,--start-group $(filter %.a,$^) -Wl,--end-group $(BOARD_LDLIBS)

# scene_link PROGRAM FOLDER FLAGS KIND: links an image of the scene $*, whose object is among the prerequisites and
# whose header is in FOLDER. KIND is --fixed for scenes in fixed point.
define scene_link
	@mkdir -p $(@D)
	$(say) LINK $@
	$(Q)mk/count/index.sh $(4) $* >$(@:.elf=.c)
	$(Q)$(call single_link,$(1) $(@:.elf=.c),-I$(2) -include $(2)/$*.h -DWH_SCENE_WORDS=$*_MEMORY_WORDS $(3))
endef
SCENE_NEEDS := $(wildcard boards/programs/*.[ch]) $(BOARD_OBJECTS) $(call libraries,$(BOARD),whirl) mk/count/index.sh
# Appended to a link command: if the image does not fit, the result is an empty file.
or_empty = 2>$(@:.elf=.log) || { grep -qE 'region|overflowed' $(@:.elf=.log) || { cat $(@:.elf=.log) >&2; exit 1; }; : >$@; }
# print_of ELF...: prints their output; "without NAME" if an image is empty or its stack too small (status 123).
print_of = printf '%s\n' $(1) | xargs -r -P $(JOBS) -n 1 sh -c 'name=$$(basename $$1 .elf | sed s/^hard_//); \
    [ -s $$1 ] || { echo "without $$name"; exit 0; }; status=0; \
    $(call emulate,$$1) >$${1%.elf}.said || status=$$?; \
    if [ $$status -eq 123 ]; then echo "without $$name"; else cat $${1%.elf}.said; [ $$status -eq 0 ]; fi' _

$(SINGLE)/scene_%.elf: $(B)/$(BOARD)/$(GEN)/%.o $(SCENE_NEEDS)
	$(call scene_link,boards/programs/scenes.c,$(GEN),-DSCENE_STEPS_MOST=$(SINGLE_STEPS)U)
# A linear scene again, with its step as one matrix (mk/price.mk).
$(SINGLE)/matrix_%.elf: $(B)/$(BOARD)/build/matrix/%.o $(SCENE_NEEDS)
	$(call scene_link,boards/programs/scenes.c,build/matrix)

# Files that several suites share; each suite links the parts that it needs.
$(SINGLE)/shared.a: $(call objects,$(BOARD),$(filter-out tests/core/test_%,$(wildcard tests/core/*.c)))
	@mkdir -p $(@D)
	$(say) AR $@
	$(Q)rm -f $@ && $(AR) rcs $@ $^

$(SINGLE)/suite_%.elf: $(B)/$(BOARD)/tests/core/test_%.o $(call objects,$(BOARD),tests/main.c $(UNITY_DIR)/unity.c) \
    $(SINGLE)/shared.a $(BOARD_OBJECTS) $(call libraries,$(BOARD),scenes station rig virtual whirl)
	@mkdir -p $(@D)
	$(say) LINK $@
	$(Q)sh tests/suites.sh tests/core/test_$*.c >$(@:.elf=.c)
	$(Q)$(call single_link,$(@:.elf=.c),$(UNITY_FLAGS))

LARGE_SCENES = $(patsubst scene_%,%,$(shell sed -n 's/^scene /scene_/p' $(TOO_LARGE) 2>/dev/null))
LARGE_SUITES = $(patsubst suite_%,%,$(shell sed -n 's/^suite /suite_/p' $(TOO_LARGE) 2>/dev/null))
SINGLE_SCENES = $(patsubst %,$(SINGLE)/scene_%.elf,$(filter-out $(LARGE_SCENES),$(SCENE_NAMES)))
SINGLE_SUITES = $(patsubst %,$(SINGLE)/suite_%.elf,$(filter-out $(LARGE_SUITES),$(SUITE_NAMES)))

IMAGES = $(SINGLE_SCENES)
board-images: $(SINGLE_SCENES) $(BOARD_RUN_BY)
board-tests: $(SINGLE_SUITES) $(BOARD_RUN_BY)
run-suites: # each image prints its number of failed tests
	@status=0; for elf in $(SINGLE_SUITES); do echo "$$elf:"; $(call emulate,$$elf) || status=1; done; exit $$status
# A line for each scene, with the hash of its last state, or "without NAME".
print-hashes:
	@for elf in $(SINGLE_SCENES); do $(call emulate,$$elf) || exit 1; done
	@for scene in $(LARGE_SCENES); do echo "without $$scene"; done
print-matrix-hashes: $(MATRIX:%=$(SINGLE)/matrix_%.elf) $(BOARD_RUN_BY)
	@for scene in $(MATRIX); do $(call emulate,$(SINGLE)/matrix_$$scene.elf) || exit 1; done

# Lists the programs that do not link, or whose stack is too small when they run (exit status 123).
too-large-now: $(BOARD_RUN_BY)
	@mkdir -p $(SINGLE); : >$(TOO_LARGE)
	@for image in $(SUITE_NAMES:%=suite_%) $(SCENE_NAMES:%=scene_%); do \
	    if $(MAKE) -s $(SINGLE)/$$image.elf >$(SINGLE)/$$image.log 2>&1; then \
	        status=0; $(call emulate,$(SINGLE)/$$image.elf) >/dev/null 2>&1 || status=$$?; \
	        [ $$status -eq 123 ] || continue; \
	    elif ! grep -qE 'region|overflowed|is too large' $(SINGLE)/$$image.log; then cat $(SINGLE)/$$image.log; exit 1; fi; \
	    echo $$image | sed 's/_/ /' >>$(TOO_LARGE); done
	@$(MAKE) -s $(LIGHT) >$(SINGLE)/firstlight.log 2>&1 || { grep -qE 'region|overflowed' $(SINGLE)/firstlight.log && \
	    echo "program firstlight" >>$(TOO_LARGE); }
	@cat $(TOO_LARGE)
