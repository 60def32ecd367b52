# price.mk: instructions a step (bench) and bytes (size). Figures are added to build/figures/*.csv.

BENCH_C := host/count/bench.c
PLUGIN := build/count_plugin.so
FIGURES := build/figures
# The same mechanisms as one writes them by hand, to compare with.
BY_HAND := naive_epicyclic naive_thomson careful_thomson
# What of the flags belongs beside a figure.
TOLD = $(filter -O% -m%,$(1))

$(PLUGIN): host/count/count_plugin.c
	@$(call need,$(CC))
	@mkdir -p $(@D)
	$(say) LINK $@
	$(Q)$(CC) -std=c11 $(WARN) -O2 -fPIC -shared -fvisibility=hidden -o $@ $<

$(B)/bench: $(call objects,float,$(BENCH_C) boards/host/board.c) $(LIB_SCENES) $(LIB_FLOAT)
	$(link)

$(B)/bench_double: $(call objects,double,$(BENCH_C) boards/host/board.c) $(LIB_SCENES_DOUBLE) \
    $(LIB_DOUBLE)
	$(link)

$(addprefix $(B)/tools/,$(BY_HAND)): $(B)/tools/%: $(B)/host/tests/tools/%.o \
    $(B)/host/tests/tools/naive_main.o
	$(link)

$(ELF)/bench.elf: $(call objects,$(BOARD),$(BENCH_C)) $(BOARD_OBJECTS) $(ELF)/libscenes.a \
    $(LIB_BOARD)
	$(link_board)

.PHONY: bench-now size-now
bench-now: build/whirl
	@$(MAKE) $(GEN)/.stamp
	@$(MAKE) build/bench build/bench_double $(addprefix build/tools/,$(BY_HAND)) $(ELF)/bench.elf \
	    $(PLUGIN)
	@mkdir -p $(FIGURES)
	@echo "Instructions a step (executed, not cycles):"
	@CC="$(CC)" FLAGS="$(OPT)" host/count/count_host.sh build/bench $(FIGURES)/bench.csv
	@CC="$(CC)" FLAGS="$(OPT)" host/count/count_host.sh build/bench_double $(FIGURES)/bench.csv
	@echo "By hand, with libm:"
	@for program in $(BY_HAND); do CC="$(CC)" FLAGS="$(OPT)" \
	    host/count/count_host.sh build/tools/$$program $(FIGURES)/bench.csv || exit 1; done
	@BOARD=$(BOARD) CC=$(BOARD_CC) NM=$(BOARD_NM) FLAGS="$(call TOLD,$(BOARD_CFLAGS))" \
	    PLUGIN=$(PLUGIN) EMULATE="$(call emulate,$(ELF)/bench.elf)" \
	    host/count/count_board.sh $(ELF)/bench.elf $(FIGURES)/bench.csv

size-now: build/whirl
	@$(MAKE) $(GEN)/.stamp
	@$(MAKE) board-images
	@mkdir -p $(FIGURES)
	@BOARD=$(BOARD) CC=$(BOARD_CC) NM=$(BOARD_NM) SIZE=$(BOARD_SIZE) OBJECTS=$(ELF) \
	    FLAGS="$(call TOLD,$(BOARD_CFLAGS))" EMULATE="$(call emulate,@)" \
	    host/size/size.sh $(FIGURES)/size.csv $(IMAGES)
