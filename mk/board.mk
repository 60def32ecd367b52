# board.mk: images for BOARD, from its boards/<board>/board.mk (variables only, explained in boards/cortexm/cortexm.mk).

BOARDS_ALL := $(sort $(patsubst boards/%/board.mk,%,$(wildcard boards/*/board.mk)))
# Boards with a row in `whirl price`. An STM32F405 is priced as its processor, mps2-an386.
BOARDS_PRICED := $(sort $(patsubst boards/%/board.mk,%,$(shell grep -L stm32f4.mk boards/*/board.mk)))
ifeq ($(filter $(BOARD),$(BOARDS_ALL)),)
$(error There is no boards/$(BOARD)/board.mk. Boards: $(BOARDS_ALL))
endif

# BOARD_WHEN says which targets include a board: `test` (`make test` and the gates of `make check`), `check` (the gates
# alone), or `all` (only targets of all boards: `make test-boards`, `make hashes-all`).
board_whens := test check all
board_of_family := $(addprefix BOARD_,DEPS CC NM SIZE OBJCOPY OBJDUMP CFLAGS LDFLAGS SOURCES TIDY EMULATOR EMULATE)

# A family checks that its boards set the variables that it needs: $(call board_needs,VARIABLES).
board_needs = $(foreach v,$(1),$(if $(strip $(value $(v))),,$(error boards/$(board)/board.mk: $(v) is missing$(2))))
board_before := $(filter BOARD_%,$(.VARIABLES))

# Every board is read, so that none is dropped silently. Only these lists remain: boards_test, boards_check,
# boards_all, boards that are flashed, and boards without room for the portable suites.
define read_board
board := $(1)
include boards/$(1)/board.mk
$$(call board_needs,BOARD_WHEN,: one of $(board_whens))
$$(if $$(filter-out 1,$$(words $$(BOARD_WHEN)))$$(filter-out $(board_whens),$$(BOARD_WHEN)),\
    $$(error boards/$(1)/board.mk: BOARD_WHEN is '$$(strip $$(BOARD_WHEN))': one of $(board_whens)))
$$(call board_needs,$(board_of_family),: its family sets it (boards/cortexm/cortexm.mk))
boards_$$(strip $$(BOARD_WHEN)) += $(1)
boards_flashed := $$(strip $$(boards_flashed) $$(if $$(BOARD_FLASHED),$(1)))
boards_without_suites += $$(if $$(filter none,$$(BOARD_SUITES)),$(1))
$$(foreach v,$$(filter-out $(board_before),$$(filter BOARD_%,$$(.VARIABLES))),$$(eval undefine $$(v)))
endef
$(foreach b,$(BOARDS_ALL),$(eval $(call read_board,$(b))))
board := $(BOARD)
include boards/$(BOARD)/board.mk

# Sanitizers and similar flags are for this machine only: boards have an EXTRA of their own.
BOARD_EXTRA ?=
$(eval $(call build,$(BOARD),$(BOARD_CC),$(BOARD_CFLAGS) $(WARN) $(BOARD_EXTRA)))

# The flashed image may have a build of its own (BOARD_FLASHED_FLAGS), for example on a chip with little memory.
FLASHED := $(BOARD)$(if $(BOARD_FLASHED_FLAGS),-flashed)
ifneq ($(BOARD_FLASHED_FLAGS),)
$(eval $(call build,$(FLASHED),$(BOARD_CC),$(BOARD_CFLAGS) $(BOARD_FLASHED_FLAGS) $(WARN) $(BOARD_EXTRA)))
$(eval $(call portable_libraries,$(FLASHED)))
endif

ELF := $(B)/$(BOARD)
BOARD_OBJECTS := $(call objects,$(BOARD),$(BOARD_SOURCES))
$(eval $(call portable_libraries,$(BOARD)))

define link_board
	@mkdir -p $(@D)
	$(say) LINK $@
	$(Q)$(BOARD_CC) $(BOARD_LDFLAGS) -Wl,-Map=$(@:.elf=.map) -o $@ $(filter %.o,$^) \
	    -Wl,--start-group $(filter %.a,$^) -Wl,--end-group $(IMAGE_LIBS) $(BOARD_LDLIBS)
endef

# program NAME SOURCES LIBRARIES HOST-SOURCES BOARD-SOURCES: the program NAME of this machine, in float, and the board's NAME.elf.
define program
$(B)/$(1): $(call objects,float,$(2) boards/host/board.c $(4)) $(call libraries,float,$(3))
	$$(link)
$(ELF)/$(1).elf: $(call objects,$(BOARD),$(2) $(5)) $(BOARD_OBJECTS) $(call libraries,$(BOARD),$(3))
	$$(link_board)
endef

# Linear scenes that are built a second time, with each step as one product with a matrix (mk/price.mk,
# tests/matrix_hashes.sh).
MATRIX := two_mass_relative cartesian_flight

# Programs with every scene, and with the rig's firmware, whose hardware hal/virtual simulates.
$(eval $(call program,scenes,boards/programs/scenes.c,scenes whirl))
$(eval $(call program,firmware,boards/programs/rig.c,whirl rig virtual scenes))

# Code that runs rarely is compiled for size, so that the code of each step has the flash.
$(foreach o,$(STATION_C) boards/programs/rig.c boards/programs/station.c \
    $(VIRTUAL_C) core/rig/swing_guess.c core/rig/state_machine.c core/text.c core/frame.c core/cobs.c $(BOARD_FLASHED),$(B)/$(BOARD)/$(o:.c=.o)): \
    FILE_FLAGS = -Os

ifneq ($(BOARD_FLASHED),)
$(B)/$(FLASHED)/boards/programs/station.o: FILE_FLAGS += -DHAL_VIRTUAL=0
endif

# The rig's firmware with a console; on this machine the console is a pseudo-terminal.
STATION := $(ELF)/station.elf
$(B)/station: $(call objects,float,boards/programs/station.c boards/host/board.c boards/host/terminal.c boards/host/settings.c) \
    $(call libraries,float,station rig virtual whirl scenes)
	$(link)
# On a board with hardware, the firmware uses the rig's hardware and no model. A flashed image never ends, and uses no
# debugger.
FLASHED_OBJECTS := $(call objects,$(FLASHED),$(BOARD_FLASHED))
FLASHED_IMAGES := $(if $(BOARD_FLASHED),$(STATION))
# Limits that mk/size/size.sh applies to the images.
SIZE_MOST := $(if $(FLASHED_IMAGES),$(BOARD_MOST) MOST_OF="$(FLASHED_IMAGES)")
ifneq ($(BOARD_FLASHED_LDFLAGS),)
$(STATION): BOARD_LDFLAGS := $(BOARD_FLASHED_LDFLAGS)
endif
$(STATION): $(call objects,$(FLASHED),boards/programs/station.c) $(or $(FLASHED_OBJECTS),$(BOARD_OBJECTS)) \
    $(if $(BOARD_FLASHED),$(call objects,$(FLASHED),$(GEN)/rig_observed.c)) \
    $(call libraries,$(FLASHED),station rig whirl $(if $(BOARD_FLASHED),,virtual scenes))
	$(link_board)

# Firmware whose plant is at the other end of a line (`whirl pil`), for families that have such a line: BOARD_LINK.
pil_program = $(call program,$(1),$(2),$(3),boards/host/link.c,$(BOARD_LINK))
$(foreach p,pil_rig pil_swing pil_dialled pil_carriage,$(eval $(call pil_program,$(p),boards/programs/$(p).c,frames rig whirl scenes)))
$(eval $(call pil_program,pil_cart,boards/programs/pil_cart.c,frames whirl))
# A controller from outside the tree: CONTROLLER names its C files. The first of them is the program.
CONTROLLER_LIBRARIES ?= frames whirl
ifneq ($(CONTROLLER),)
pil_own := own/$(basename $(notdir $(firstword $(CONTROLLER))))
$(foreach f,$(CONTROLLER),$(if $(wildcard $(f)),,$(error CONTROLLER=$(f): there is no such file)))
$(eval $(call pil_program,$(pil_own),$(abspath $(CONTROLLER)),$(CONTROLLER_LIBRARIES)))
endif
# The same firmware over the board's own console, for boards with room for it; on this machine over a pseudo-terminal.
$(eval $(call program,pil_line,boards/programs/pil_line.c boards/shared/link_console.c,frames rig whirl scenes,boards/host/terminal.c))
PIL_PROGRAMS := pil_rig pil_swing pil_dialled pil_carriage pil_cart
PIL_IMAGES := $(if $(BOARD_LINK),$(PIL_PROGRAMS:%=$(ELF)/%.elf) $(ELF)/pil_line.elf)

# Runs the rig on BOARD and on a Cortex-M3, and replays the tape of each on the other.
PIL_BOARDS := $(BOARD) $(filter-out $(BOARD),mps2-an385)
##@ Tests and quality
pil-images: $(PIL_PROGRAMS:%=$(B)/%) $(PIL_IMAGES) ## firmware for `whirl pil`, for this machine and for BOARD
pil-image: $(if $(CONTROLLER),$(B)/$(pil_own) $(if $(BOARD_LINK),$(ELF)/$(pil_own).elf)) ## the same of a controller of your own: CONTROLLER="my.c more.c"
	@[ -n "$(CONTROLLER)" ] || { echo "error: no controller; such as: make pil-image CONTROLLER=path/to/my.c BOARD=mps2-an386" >&2; exit 2; }
pil-now: $(B)/whirl
	@$(call need,qemu-system-arm)
	+@$(foreach b,$(PIL_BOARDS),$(call on_board,$(b),pil-images) &&) true
	@sh mk/demo/pil.sh $(B)/whirl $(PIL_BOARDS)

# Only the test framework uses the C library: the jump out of a failed test.
$(ELF)/tests.elf $(ELF)/tests_less.elf: IMAGE_LIBS := -lc
$(ELF)/tests.elf: $(call objects,$(BOARD),$(CORE_TEST_PARTS))
$(ELF)/tests_less.elf: $(call objects,$(BOARD),$(CORE_LESS_PARTS))
$(ELF)/tests.elf $(ELF)/tests_less.elf: $(BOARD_OBJECTS) $(call libraries,$(BOARD),scenes station rig virtual whirl)
	$(link_board)
# SUITES=less: all suites except CORE_RUNS.
TESTS_ELF := $(ELF)/tests$(SUITES:%=_%).elf

emulate = $(call BOARD_EMULATE,$(1))

# Files that only this board compiles, for checks of single files.
BOARD_OWN_C = $(sort $(BOARD_SOURCES) $(if $(BOARD_FLASHED_FLAGS),,$(BOARD_FLASHED))) $(BOARD_LINK) $(wildcard tests/boards/guard_*.c)
# Files that only its separate flashed build compiles.
BOARD_FLASHED_C = $(if $(BOARD_FLASHED_FLAGS),$(BOARD_FLASHED))

ifeq ($(BOARD_IMAGES),single)
include mk/single.mk
else
# Images that must follow the firmware rules, and whose sizes are printed.
IMAGES := $(ELF)/scenes.elf $(ELF)/firmware.elf $(STATION)

# Programs that touch the guard of the stack and must not return (tests/boards/guard.sh).
GUARDS := $(patsubst tests/boards/%.c,$(ELF)/%.elf,$(wildcard tests/boards/guard_*.c))
$(GUARDS): $(ELF)/%.elf: $(B)/$(BOARD)/tests/boards/%.o $(BOARD_OBJECTS) $(call libraries,$(BOARD),whirl)
	$(link_board)

board-images: $(IMAGES) ##- with BOARD=: its images of the scenes
board-tests: $(TESTS_ELF) $(GUARDS) $(PIL_IMAGES) $(STATION) $(ELF)/firstlight.elf
run-suites: # the portable suites, the guard of the stack, and first light
	@status=0; $(call emulate,$(TESTS_ELF)) || status=1; sh tests/boards/guard.sh $(BOARD) || status=1; \
	    sh tests/boards/firstlight.sh $(BOARD) || status=1; exit $$status
print-hashes: ##- with BOARD=: a line for each scene, with the hash of its last state
	@$(call need,$(BOARD_EMULATOR))
	@$(call emulate,$(ELF)/scenes.elf)
# The first steps of each scene. A specs file may be given only once.
$(ELF)/scenes_short.elf: boards/programs/scenes.c $(BOARD_OBJECTS) $(call libraries,$(BOARD),scenes whirl)
	@mkdir -p $(@D)
	$(say) LINK $@
	$(Q)$(BOARD_CC) $(BOARD_CFLAGS) $(WARN) $(BOARD_EXTRA) -DSCENE_STEPS_MOST=$(SINGLE_STEPS)U $(filter-out $(BOARD_CFLAGS),$(BOARD_LDFLAGS)) -o $@ $(filter %.c %.o,$^) \
	    -Wl,--start-group $(filter %.a,$^) -Wl,--end-group $(IMAGE_LIBS) $(BOARD_LDLIBS)
short-images: $(ELF)/scenes_short.elf
print-short-hashes:
	@$(call emulate,$(ELF)/scenes_short.elf)
print-matrix-hashes: $(ELF)/scenes_matrix.elf # hashes of linear scenes whose step is one matrix
	@$(call need,$(BOARD_EMULATOR))
	@$(call emulate,$<)
endif

# Each board is built and run by its own make: $(call on_board,NAME,TARGET).
BOARDS_TEST := $(sort $(filter-out $(boards_without_suites),$(BOARD)) $(boards_test))
BOARDS := $(sort $(BOARD) $(boards_test) $(boards_check))
# Boards with one image per scene run at most this many steps, because a second on this machine takes hours on them.
BOARDS_SINGLE := $(patsubst boards/%/too_large.txt,%,$(wildcard boards/*/too_large.txt))
SINGLE_STEPS ?= 2000
on_board = $(MAKE) -s BOARD=$(1) $(2)
emulate-command: # the emulator's command for the image IMAGE
	@echo '$(call emulate,IMAGE)'

# Files that a family has beside its boards, for every BOARD: rules for tools and test programs, and gates, named in
# FAMILY_GATES.
include $(wildcard boards/*/family.mk)

-include $(wildcard $(foreach b,$(sort $(BOARD) $(FLASHED)),$(patsubst %.c,$(B)/$(b)/%.d,$(UNITY_DIR)/unity.c $(PORTABLE_C) $(BOARD_C) $(TEST_C) $(SCENE_C) $(B)/tests/core_suites.c)))

emulate-now: $(GEN)/.stamp
	@$(MAKE) $(ELF)/firmware.elf
	@$(call emulate,$(ELF)/firmware.elf)
