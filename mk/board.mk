# board.mk: images for BOARD, from its boards/<board>/board.mk (variables only, explained in boards/cortexm/cortexm.mk).

ifeq ($(wildcard boards/$(BOARD)/board.mk),)
$(error There is no boards/$(BOARD)/board.mk. Boards: $(patsubst boards/%/board.mk,%,$(wildcard boards/*/board.mk)))
endif
include boards/$(BOARD)/board.mk

# Sanitizers and the like stay on this machine: boards have an EXTRA of their own.
BOARD_EXTRA ?=
$(eval $(call build,$(BOARD),$(BOARD_CC),$(BOARD_CFLAGS) $(WARN) $(BOARD_EXTRA)))

ELF := $(B)/$(BOARD)
BOARD_OBJECTS := $(call objects,$(BOARD),$(BOARD_SOURCES))
LIB_BOARD := $(ELF)/libwhirl.a

$(LIB_BOARD): $(call objects,$(BOARD),$(CORE_C) $(HAL_C))
	$(archive)

$(ELF)/libscenes.a: $(call objects,$(BOARD),$(SCENE_C))
	$(archive)

define link_board
	$(say) LINK $@
	$(Q)$(BOARD_CC) $(BOARD_LDFLAGS) -Wl,-Map=$(@:.elf=.map) -o $@ $(filter %.o,$^) \
	    -Wl,--start-group $(filter %.a,$^) -Wl,--end-group $(IMAGE_LIBS) $(BOARD_LDLIBS)
endef

# Only the test framework takes something from a C library: the jump out of a failed test.
$(ELF)/tests.elf: IMAGE_LIBS := -lc
$(ELF)/tests.elf: $(call objects,$(BOARD),$(CORE_TEST_PARTS)) $(BOARD_OBJECTS) $(ELF)/libscenes.a \
    $(LIB_BOARD)
	$(link_board)

$(ELF)/scenes.elf: $(call objects,$(BOARD),boards/programs/scenes.c) $(BOARD_OBJECTS) \
    $(ELF)/libscenes.a $(LIB_BOARD)
	$(link_board)

$(ELF)/firmware.elf: $(call objects,$(BOARD),boards/programs/rig.c) $(BOARD_OBJECTS) $(ELF)/libscenes.a \
    $(LIB_BOARD)
	$(link_board)

# The same firmware as a program of this machine, with the hardware played by hal/virtual.
$(B)/firmware: $(call objects,float,boards/programs/rig.c boards/host/board.c) $(LIB_SCENES) \
    $(LIB_FLOAT)
	$(link)

# The images that are held to the firmware rules and whose sizes are told.
IMAGES := $(ELF)/scenes.elf $(ELF)/firmware.elf

.PHONY: board-images board-tests
board-images: $(IMAGES)
board-tests: $(ELF)/tests.elf

emulate = $(call BOARD_EMULATE,$(1))

# The boards beside BOARD are built and run by a make of their own: $(call on_board,NAME,TARGET).
BOARDS := $(patsubst boards/%/board.mk,%,$(wildcard boards/*/board.mk))
OTHER_BOARDS := $(filter-out $(BOARD),$(BOARDS))
on_board = $(MAKE) -s BOARD=$(1) $(2)
.PHONY: run-image
run-image:
	@$(call emulate,$(IMAGE))

-include $(wildcard $(patsubst %.c,$(ELF)/%.d,$(UNITY_DIR)/unity.c $(CORE_C) $(HAL_C) $(BOARD_C) $(TEST_C) $(SCENE_C) $(B)/tests/core_suites.c))

.PHONY: emulate-now
emulate-now: build/whirl
	@$(MAKE) $(GEN)/.stamp
	@$(MAKE) $(ELF)/firmware.elf
	@$(call emulate,$(ELF)/firmware.elf)
