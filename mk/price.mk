# price.mk: instructions per step (bench) and bytes (size). The figures are appended to build/figures/*.csv.

BENCH_C := boards/programs/bench.c
PLUGIN := build/count_plugin.so
FIGURES := build/figures
# The same mechanisms written by hand, to compare with.
BY_HAND := naive_epicyclic naive_thomson careful_thomson
# On the board, some scenes also run with many steps per call. On this machine, the instructions of a function are
# counted without those of the functions that it calls.
MULTI_STEP := epicyclic_from_rest epicyclic_conserved thomson_a thomson_a_conserved rig_fixed
again_matrix := --matrix exact
again_c = $(patsubst %,build/$(1)/%.c,scenes $($(2)))
MULTI_STEP_C := $(call again_c,multi_step,MULTI_STEP)
MATRIX_C := $(call again_c,matrix,MATRIX)
# The flags that are stored beside a figure.
TOLD = $(filter -O% -m%,$(1))

PLUGIN_C := mk/count/count_plugin.c mk/count/thumb_cycles.c
$(PLUGIN): $(PLUGIN_C) mk/count/thumb_cycles.h
	@$(call need,$(CC))
	@mkdir -p $(@D)
	$(say) LINK $@
	$(Q)$(CC) -std=c11 $(WARN) -O2 -I. -fPIC -shared -fvisibility=hidden -o $@ $(PLUGIN_C)

$(eval $(call program,bench,$(BENCH_C),scenes whirl))
$(eval $(call program,bench_multi_step,$(BENCH_C) $(MULTI_STEP_C),whirl))
$(eval $(call program,scenes_matrix,boards/programs/scenes.c $(MATRIX_C),whirl))
$(ELF)/build/multi_step/%.o $(B)/float/build/multi_step/%.o: FILE_FLAGS := -DWH_MULTI_STEP=1

$(B)/bench_double: $(call objects,double,$(BENCH_C) boards/host/board.c) \
    $(call libraries,double,scenes whirl)
	$(link)

# scenes_again FOLDER SCENES: writes the C of these scenes, with the options in again_FOLDER, and their table.
define scenes_again
$(2:%=build/$(1)/%.c): build/$(1)/%.c: build/whirl mk/price.mk
	@mkdir -p $$(@D)
	$$(say) GEN $$@
	$$(Q)build/whirl derive $$* --as c $(again_$(1)) --header $$(@:.c=.h) >$$@
build/$(1)/scenes.c: mk/count/index.sh $(2:%=build/$(1)/%.c)
	@mkdir -p $$(@D)
	$$(say) GEN $$@
	$$(Q)$$< $(2) >$$@
endef
$(eval $(call scenes_again,multi_step,$(MULTI_STEP)))
$(eval $(call scenes_again,matrix,$(MATRIX)))
.SECONDARY: $(MULTI_STEP_C) $(MATRIX_C)

$(addprefix $(B)/tools/,$(BY_HAND)): $(B)/tools/%: $(B)/host/tests/tools/%.o \
    $(B)/host/tests/tools/naive_main.o
	$(link)

count_board = BOARD=$(BOARD) CC=$(BOARD_CC) NM=$(BOARD_NM) \
    FLAGS="$(call TOLD,$(BOARD_CFLAGS))" PLUGIN=$(PLUGIN) TIMING=$(BOARD_TIMING) EMULATE="$(call emulate,$(1))" \
    mk/count/count_rows.sh $(FIGURES)/bench.csv $(1)

# Number of random steps, with all effects, from which the longest step of scenes with contacts is taken.
WORST_STEPS ?= 1000000
WORST_MODELS ?= $(MODELS)
WORST_C := boards/programs/worst.c $(wildcard build/worst_step/*.c)
$(eval $(call program,worst,$(WORST_C),whirl))
$(ELF)/build/worst_step/%.o: FILE_FLAGS := -include boards/programs/mark.h
$(ELF)/boards/programs/worst.o: FILE_FLAGS := -DWORST_STEPS=$(WORST_STEPS)U -DWORST_SEEDS=2U

.PHONY: bench-now size-now worst-now
worst-now: $(GEN)/.stamp
	@[ "$(WORST_STEPS)" -gt 0 ] 2>/dev/null || \
	    { echo "error: WORST_STEPS=$(WORST_STEPS): a number of steps, 1 or more" >&2; exit 2; }
	@mk/count/all_effects.sh build/whirl build/worst_step $(WORST_MODELS)
	@$(RM) $(ELF)/boards/programs/worst.o
	@$(MAKE) $(ELF)/worst.elf $(PLUGIN)
	@mkdir -p $(FIGURES)
	@echo "Two times $(WORST_STEPS) random steps of each scene:"
	@BOARD=$(BOARD) CC=$(BOARD_CC) NM=$(BOARD_NM) OBJCOPY=$(BOARD_OBJCOPY) \
	    FLAGS="$(call TOLD,$(BOARD_CFLAGS))" PLUGIN=$(PLUGIN) \
	    EMULATE="$(subst limit.sh $(BOARD_SECONDS),limit.sh 3600,$(call emulate,$(ELF)/worst.elf))" \
	    mk/count/worst.sh $(ELF)/worst.elf $(FIGURES)/worst.csv $(WORST_STEPS)

bench-now: $(GEN)/.stamp
	@$(MAKE) build/bench $(addprefix build/tools/,$(BY_HAND)) $(PLUGIN) $(ELF)/bench.elf $(ELF)/bench_multi_step.elf
	@$(MAKE) B=build/optimised LEAST_O2= build/optimised/bench_double # the tests' objects in double are compiled at -O0
	@mkdir -p $(FIGURES)
	@echo "Instructions a step (executed, not cycles):"
	@for program in bench optimised/bench_double $(addprefix tools/,$(BY_HAND)); do \
	    BOARD=host CC="$(CC)" FLAGS="$(OPT)" \
	        mk/count/count_rows.sh $(FIGURES)/bench.csv build/$$program || exit 1; done
	@$(call count_board,$(ELF)/bench.elf)
	@$(call count_board,$(ELF)/bench_multi_step.elf)

# --- every board beside the others ----------------------------------------------------------------
# The steps of these scenes are counted as for price-rows: instructions, cycles if something counts or estimates them, bytes.
PRICED := epicyclic_from_rest epicyclic_conserved thomson_a thomson_a_conserved rig_fixed
.PHONY: bench-boards-now
bench-boards-now: build/whirl
	@mkdir -p build/boards $(FIGURES)
	@printf '%s\n' $(foreach s,$(PRICED),"$(s) $(s)") >build/boards/cases
	+@for board in $(BOARDS_PRICED); do $(MAKE) BOARD=$$board price-measure-board PRICE_OUT=build/boards \
	    PRICE_CSV=$(FIGURES)/boards.csv || exit 1; done
	@awk -F, -f mk/count/boards_table.awk $(FIGURES)/boards.csv >build/boards.md
	@mk/price/into_page.sh build/boards.md docs/dev/price.md boards
	@cat build/boards.md

# Flash, memory and stack of images: from the compiler's call graph, or from the code (a family's BOARD_SIZE_BY).
size_of = BOARD=$(BOARD) CC=$(BOARD_CC) NM=$(BOARD_NM) SIZE=$(BOARD_SIZE) OBJDUMP=$(BOARD_OBJDUMP) OBJECTS="$(sort $(ELF) $(B)/$(FLASHED))" $(SIZE_MOST) \
    FLAGS="$(call TOLD,$(BOARD_CFLAGS))" $(or $(BOARD_SIZE_BY),mk/size/size.sh) $(FIGURES)/size.csv $(1)

ifeq ($(BOARD_IMAGES),single)
size-now: $(GEN)/.stamp
	@[ -n "$(BOARD_FLASHED)" ] || { echo "size: $(BOARD) has an image a scene, and none of the rig" >&2; exit 2; }
	@$(MAKE) $(STATION)
	@mkdir -p $(FIGURES)
	@$(call size_of,$(STATION))
else
size-now: $(GEN)/.stamp
	@$(MAKE) board-images
	@mkdir -p $(FIGURES)
	@$(call size_of,$(IMAGES))
	@CC=$(BOARD_CC) CPU="$(BOARD_CPU)" SIZE=$(BOARD_SIZE) mk/size/functions.sh $(ELF)/$(GEN) boards/$(BOARD)/most_bytes.txt \
	    $(call libraries,$(BOARD),whirl rig virtual scenes)
endif

# Settings for programs that build and count scenes of their own.
TO_PRICE = WHIRL=build/whirl BOARD=$(BOARD) BOARD_CC=$(BOARD_CC) BOARD_NM=$(BOARD_NM) \
    BOARD_SIZE=$(BOARD_SIZE) BOARD_CFLAGS="$(BOARD_CFLAGS)" BOARD_LDFLAGS="$(BOARD_LDFLAGS)" \
    BOARD_LDLIBS="$(BOARD_LDLIBS)" BOARD_OBJECTS="$(BOARD_OBJECTS)" LIB_BOARD=$(call libraries,$(BOARD),whirl) \
    PLUGIN=$(PLUGIN) FLAGS="$(call TOLD,$(BOARD_CFLAGS))" EMULATE="$(call emulate,@)"

# --- prices of any scene: cases are counted, and become a table of figures (docs/dev/price.md) -------------------------------
PRICE_OUT ?= build/cost
PRICE_CASES ?= $(PRICE_OUT)/cases
PRICE_CSV ?= $(PRICE_OUT)/rows.csv
NUMBERS ?= float

# The board's core in double, for cases that are counted in double.
$(eval $(call build,double_$(BOARD),$(BOARD_CC),$(BOARD_CFLAGS) -DWH_DOUBLE=1 -w))
$(eval $(call library,$(B)/double_$(BOARD)/libwhirl.a,$(call objects,double_$(BOARD),$(CORE_C))))
LIB_DOUBLE_BOARD := $(B)/double_$(BOARD)/libwhirl.a

# Needed for counting: the files that are compiled once, and the emulator.
.PHONY: price-ready-board price-ready-host price-measure-board price-measure-host price-count-run-board
price-ready-board: build/whirl
	@$(if $(filter single,$(BOARD_IMAGES)),true,$(call need,$(BOARD_EMULATOR)))
	@$(MAKE) $(BOARD_OBJECTS) $(call libraries,$(BOARD),whirl) $(if $(filter double,$(NUMBERS)),$(LIB_DOUBLE_BOARD)) \
	    $(or $(BOARD_RUN_BY),$(PLUGIN))
price-ready-host: build/whirl
	@$(call need,valgrind)
	@$(MAKE) $(LIB_FLOAT) $(if $(filter double,$(NUMBERS)),$(LIB_DOUBLE)) $(B)/float/boards/host/board.o
price-measure-board: price-ready-board
	@mkdir -p $(PRICE_OUT)
	@OUT=$(PRICE_OUT) NUMBERS="$(NUMBERS)" TIMING=$(BOARD_TIMING) $(TO_PRICE) LIB_DOUBLE=$(LIB_DOUBLE_BOARD) \
	    $(if $(filter single,$(BOARD_IMAGES)),PLUGIN=) mk/price/measure.sh $(PRICE_CASES) $(PRICE_CSV)
price-count-run-board: price-ready-board
	@mkdir -p $(PRICE_OUT)
	@OUT=$(PRICE_OUT) NUMBER=$(NUMBERS) TIMING=$(BOARD_TIMING) BOARD_OBJCOPY=$(BOARD_OBJCOPY) $(TO_PRICE) \
	    LIB_DOUBLE=$(LIB_DOUBLE_BOARD) $(if $(filter single,$(BOARD_IMAGES)),PLUGIN=) mk/price/count_run.sh $(PRICE_CASES) $(PRICE_CSV)
price-measure-host: price-ready-host
	@mkdir -p $(PRICE_OUT)
	@OUT=$(PRICE_OUT) NUMBERS="$(NUMBERS)" WHIRL=build/whirl BOARD=host BOARD_CC=$(CC) BOARD_NM=nm BOARD_SIZE=size \
	    BOARD_CFLAGS="$(FLAGS_float)" BOARD_LDFLAGS="" BOARD_LDLIBS="" BOARD_OBJECTS=$(B)/float/boards/host/board.o \
	    LIB_BOARD=$(LIB_FLOAT) LIB_DOUBLE=$(LIB_DOUBLE) PLUGIN= FLAGS="$(OPT)" EMULATE="@" mk/price/measure.sh $(PRICE_CASES) $(PRICE_CSV)

$(B)/tools/price_table: $(call objects,host,mk/price/table.c) $(LIB_HOST) $(LIB_FLOAT) $(LIB_DOUBLE)
	$(link)

# Counts cases on every board in float, on some boards in double and in fixed point.
PRICE_SEED ?= 1
PRICE_MANY := mps2-an386
PRICE_DOUBLE := mps2-an386 mps2-an385-m0 mps2-an385
.PHONY: price-rows-now price-table
price-rows-now: build/whirl build/tools/mechanisms
	@rm -rf $(PRICE_OUT) && mkdir -p $(PRICE_OUT)
	@WHIRL=build/whirl sh mk/price/cases.sh $(PRICE_OUT) $(PRICE_SEED) 160 float >$(PRICE_OUT)/many
	@head -n 110 $(PRICE_OUT)/many >$(PRICE_OUT)/some
	@WHIRL=build/whirl sh mk/price/cases.sh $(PRICE_OUT) $(PRICE_SEED) 50 fixed >$(PRICE_OUT)/fixed
	+@count() { $(MAKE) PRICE_CASES=$(PRICE_OUT)/$$1 NUMBERS="$$2" $$3 || true; }; \
	    count some "float double" price-measure-host; \
	    for board in $(BOARDS_PRICED); do \
	        case " $(PRICE_MANY) " in *" $$board "*) count many float "BOARD=$$board price-measure-board" ;; \
	        *) count some float "BOARD=$$board price-measure-board" ;; esac; \
	        count fixed fixed "BOARD=$$board price-measure-board"; done; \
	    for board in $(PRICE_DOUBLE); do count some double "BOARD=$$board price-measure-board"; done
	@wc -l <$(PRICE_CSV)

##@ Price
price-table: build/tools/price_table ##- the table of figures that prices are predicted from, of the counted rows; host/study/cost_rows.inc, docs/dev/price.md
	@build/tools/price_table $(PRICE_CSV) >$(PRICE_OUT)/cost_rows.inc 2>$(PRICE_OUT)/errors.md
	@cp $(PRICE_OUT)/cost_rows.inc host/study/cost_rows.inc
	@mk/price/into_page.sh $(PRICE_OUT)/errors.md docs/dev/price.md cost
	@cat $(PRICE_OUT)/errors.md
