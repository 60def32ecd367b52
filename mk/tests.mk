# tests.mk: the test programs and running them.
# tests/core   portable suites: run here in double and in float, and on the emulated board
# tests/host   suites of the program's own parts, on this machine
# tests/chip   drivers of the STM32F405, on a chip that is played from its manual
# tests/cli    scripts that drive build/whirl; each prints "ok - ..." or "not ok - ..." lines
# Suites join by themselves: tests/*/test_*.c with lines `TEST(x, name) {` (tests/suites.sh). A test program takes
# names of suites (build/tests/host lang) and runs only those.

CORE_TEST_C := tests/main.c $(sort $(wildcard tests/core/*.c))
HOST_TEST_C := tests/main.c $(sort $(wildcard tests/host/*.c))
CLI_TESTS := $(sort $(wildcard tests/cli/*.sh))

UNITY_DIR := build/unity
UNITY_FLAGS := -DUNITY_INCLUDE_CONFIG_H -Itests -isystem $(UNITY_DIR)
$(B)/%/unity.o: FILE_FLAGS = $(UNITY_FLAGS) -w
$(foreach b,host float double $(BOARD),$(eval $(B)/$(b)/tests/%.o: FILE_FLAGS = $(UNITY_FLAGS)) \
    $(eval $(B)/$(b)/$(B)/tests/%.o: FILE_FLAGS = $(UNITY_FLAGS)))

# Test programs are not measured, and most take longer to compile than to run. So double is tested without optimisation, the
# portable suites in float and the host's at -O1, and boards (whose warnings thus count) at the programs' level. A file of
# all methods by all forms takes four times as long at -O2 as at -O1.
# Below -O2 gcc gives false warnings about uninitialized values and truncated texts.
QUIET = $(if $(findstring clang,$(CC)),,-Wno-maybe-uninitialized -Wno-format-truncation)
LESS = $(if $(filter -O0,$(OPT)),,-O1 $(QUIET))
LESS_O2 = $(if $(filter -O2,$(OPT)),-O1 $(QUIET))
LEAST_O2 = $(if $(filter -O2,$(OPT)),-O0 $(QUIET))
$(B)/double/tests/core/%.o: FILE_FLAGS = $(UNITY_FLAGS) $(LEAST_O2)
$(B)/float/tests/core/%.o: FILE_FLAGS = $(UNITY_FLAGS) $(or $(CORE_TEST_OPT),$(LESS_O2))
$(B)/host/tests/host/%.o: FILE_FLAGS = $(UNITY_FLAGS) $(or $(TEST_OPT),$(LESS_O2))
$(patsubst %,$(B)/$(BOARD)/tests/core/%.o,test_stage_turn test_stage_turn_ledger): FILE_FLAGS = $(UNITY_FLAGS) $(LESS)

$(UNITY_DIR)/unity.c:
	@UNITY="$(UNITY)" mk/setup/unity.sh $(UNITY_DIR)

# --- programs -----------------------------------------------------------------------------------
# suites_of FILES: the suites in these files, a line "test_NAME.c" each. A file has one or more suites.
suites_of = sh tests/suites.sh list $(1) | sed 's|\(.*\) .*|test_\1.c|'
$(foreach t,core host chip,$(B)/tests/$(t)_suites.list): $(B)/tests/%_suites.list: FORCE
	@mkdir -p $(@D)
	@$(call suites_of,tests/$*/test_*.c) | sort >$@.new; cmp -s $@.new $@ || cp $@.new $@

$(B)/tests/quick_suites.list: $(B)/tests/host_suites.list mk/tests.mk
	@printf 'test_%s.c\n' $(HOST_GATED) | grep -vxFf - $< >$@

$(B)/tests/core_suites.c: $(CORE_TEST_C)
$(B)/tests/host_suites.c: $(HOST_TEST_C)
$(foreach t,core host chip,$(B)/tests/$(t)_suites.c): $(B)/tests/%_suites.c: tests/suites.sh $(B)/tests/%_suites.list
	$(say) GEN $@
	$(Q)sh $< tests/$*/test_*.c >$@

CORE_TEST_PARTS := $(CORE_TEST_C) $(B)/tests/core_suites.c $(UNITY_DIR)/unity.c
# Suites that the emulator leaves to this machine, except in `make full` and `make test-boards`: whole runs of the
# rig. They run here in float and double, and their bits are equal on all boards (gate-hashes). Boards keep the suites
# of conversions, roots, functions and the core's steps, which differ between processors.
CORE_RUNS := rig_gravity rig_lead rig_motor rig_observer rig_off rig_pulses rig_run rig_slope rig_swing rig_swing_pulses \
    virtual_rig_faults
CORE_LESS_C := $(filter-out $(CORE_RUNS:%=tests/core/test_%.c),$(CORE_TEST_C))
CORE_LESS_PARTS := $(CORE_LESS_C) $(B)/tests/less_suites.c $(UNITY_DIR)/unity.c
$(B)/tests/less_suites.c: tests/suites.sh mk/tests.mk $(CORE_LESS_C)
	$(say) GEN $@
	$(Q)mkdir -p $(@D) && sh $< $(filter tests/core/test_%,$(CORE_LESS_C)) >$@
HOST_TEST_PARTS := $(HOST_TEST_C) mk/count/thumb_cycles.c $(B)/tests/host_suites.c $(UNITY_DIR)/unity.c
$(foreach b,host float double $(BOARD),$(call objects,$(b),$(CORE_TEST_PARTS) $(HOST_TEST_PARTS) tests/tools/long_runs.c)): \
    | $(UNITY_DIR)/unity.c

$(B)/tests/core_float: $(call objects,float,$(CORE_TEST_PARTS)) $(call libraries,float,scenes station rig virtual whirl)
$(B)/tests/core_double: $(call objects,double,$(CORE_TEST_PARTS)) $(call libraries,double,scenes station rig whirl)
$(B)/tests/core_float $(B)/tests/core_double:
	$(link)

$(B)/tests/host: $(call objects,host,$(HOST_TEST_PARTS)) $(LIB_HOST) \
    $(call libraries,float,scenes rig whirl) $(LIB_DOUBLE) | $(B)/pil_cart
	$(link)

# The drivers of the STM32F405 on the chip model (tests/chip), which takes interrupts and resets. The drivers' variables are
# in sections of their own, so that a start of the chip can restore them from the image.
CHIP_TEST_C := tests/main.c $(sort $(wildcard tests/chip/*.c))
CHIP_DRIVERS_C := boards/cortexm/board.c boards/cortexm/fault_words.c $(addprefix boards/shared/,reset_words.c rig_time.c wait.c) $(addprefix boards/stm32f4/,brown_out.c cell.c clock.c flash.c motor.c pins.c reset.c ring.c \
    rig_clock.c slots.c stop.c time_base.c usart.c watchdog.c)
CHIP_FLAGS := -DBOARD_REGISTERS_FAKED=1 -Iboards/netduinoplus2
CHIP_BOARDS := netduinoplus2 stm32-h405 feather-f405
$(eval $(call build,chip,$(CC),$(FLAGS_host) $(CHIP_FLAGS)))
$(B)/chip/tests/%.o $(B)/chip/$(B)/tests/%.o: FILE_FLAGS = $(UNITY_FLAGS) $(LESS_O2)
CHIP_TEST_PARTS := $(CHIP_TEST_C) $(B)/tests/chip_suites.c $(UNITY_DIR)/unity.c
$(call objects,chip,$(CHIP_TEST_PARTS)): | $(UNITY_DIR)/unity.c
# The chip model runs the whole image of first light (firstlight.mk).
CHIP_LIGHT_C := boards/programs/firstlight.c
$(foreach b,$(CHIP_BOARDS),$(B)/chip_$(b)/$(CHIP_LIGHT_C:.c=.o)): private FILE_FLAGS = -Dmain=firstlight_main -DLIGHT_HARDWARE=1
$(foreach b,$(CHIP_BOARDS),$(B)/chip_$(b)/$(CHIP_LIGHT_C:.c=.o)): | $(GEN)/.stamp
$(B)/tests/chip_suites.c: $(CHIP_TEST_C)

# chip_board BOARD: the suites with the drivers of one board.
define chip_board
$(eval $(call build,chip_$(1),$(CC),$(FLAGS_host) -DBOARD_REGISTERS_FAKED=1 -Iboards/$(1)))
$(B)/chip_$(1)/drivers.o: $(call objects,chip_$(1),$(CHIP_DRIVERS_C) $(CHIP_LIGHT_C))
	$$(say) LINK $$@
	$$(Q)ld -r -o $$@ $$^
	$$(Q)objcopy --set-section-flags .bss=alloc,load,contents,data --rename-section .bss=drivers_bss \
	    --rename-section .data=drivers_data $$@

$(B)/tests/chip_$(1): $(call objects,chip,$(CHIP_TEST_PARTS) host/monitor/light.c) $(B)/chip_$(1)/drivers.o \
    $(call libraries,float,scenes station rig whirl)
	$$(link)
endef
$(foreach b,$(CHIP_BOARDS),$(eval $(call chip_board,$(b))))
-include $(wildcard $(patsubst %.c,$(B)/chip/%.d,$(CHIP_TEST_PARTS)) \
    $(foreach b,$(CHIP_BOARDS),$(patsubst %.c,$(B)/chip_$(b)/%.d,$(CHIP_DRIVERS_C) $(CHIP_LIGHT_C))))

TEST_PROGRAMS := $(CHIP_BOARDS:%=$(B)/tests/chip_%) $(B)/tests/core_double $(B)/tests/core_float $(B)/tests/host $(B)/tools/mechanisms $(B)/tools/linkages $(B)/tools/price_table \
    $(B)/pil_rig $(B)/pil_swing $(B)/pil_dialled $(B)/pil_carriage $(B)/pil_cart $(B)/pil_line $(B)/tools/faults $(B)/station $(B)/tools/sim_station $(B)/tools/tel_check

test-programs: $(TEST_PROGRAMS) $(B)/tests/quick_suites.list

# --- running ------------------------------------------------------------------------------------
# tests/run.sh takes pairs: a name and a command.
# Suites that are the same on every board run once.
RUN_CHIP = $(foreach b,$(CHIP_BOARDS),"drivers of the STM32F405 on a played chip$(comma) $(b)" \
    "$(B)/tests/chip_$(b) $(if $(filter netduinoplus2,$(b)),,chip_clock chip_slots chip_cell chip_firstlight)")
RUN_CORE = "portable suites, double" $(B)/tests/core_double "portable suites, float" $(B)/tests/core_float
# The host suites run in four parts, so that all processors are busy to the end; the longest start first. Of random cases CI
# takes few of every class (WHIRL_FEW), a suite by hand the usual number, and `make full` all.
part = "host suites$(comma) part $(1) of 4" 'WHIRL_FEW=1 sh tests/each.sh $(B)/tests/host $$(sh tests/part.sh $(2) $(1) 4)'
run_host = $(foreach p,0 1 2 3,$(call part,$(p),$(1)))
CLI_LONG := $(foreach t,docs commands embed_sketch,tests/cli/$(t).sh)
run_cli = $(foreach t,$(1),"$(t)" "sh $(t)")
# Left to gate-long, so that `make test` takes less than five minutes: suites that take long, or that compare digits
# of code that other suites run, too.
CLI_GATED := $(foreach t,angle_parts carriage embed_headers embed_names emitted_c faults figures fixed flags headers map measure odd_values pil plots price \
    printed_zeros prove recorded_lists settings_bits structure trust,\
    tests/cli/$(t).sh)
# Of these, only `make full` runs suites that compare many runs for a minute or more, and all cases of price.sh.
CLI_FULL := $(foreach t,map measure price,tests/cli/$(t).sh)
HOST_FULL := choice earlier_requests lockin_truth trajectory trust trust_scenes
HOST_GATED := busy busy_beside choice contact_bound contact_centres contact_holds contact_load contact_rest contact_start contact_together \
    earlier_requests exact_books far_slopes fixed_ranges force_free hard_cases hard_edges hybrids ledger_scenes lockin_truth map methods \
    prove_drawn reference repeats_truth rounding stabilized tables tape_gauge trajectory trust trust_scenes warnings
RUN_HOST = $(call run_host,$(B)/tests/quick_suites.list)
RUN_CLI = $(call run_cli,$(CLI_LONG) $(filter-out $(CLI_LONG) $(CLI_GATED),$(CLI_TESTS)))
run_board = "portable suites$(comma) $(1)" "$(call on_board,$(1),run-suites)"
RUN_BOARD = $(foreach b,$(BOARDS_TEST),$(call run_board,$(b)))
build_board_tests = $(foreach b,$(1),$(call on_board,$(b),board-tests) &&) true

test-now: export SUITES = less
test-now: $(GEN)/.stamp
	@$(MAKE) test-programs
	+@$(call build_board_tests,$(BOARDS_TEST))
	@[ ! -t 1 ] || printf "\033[K"
	@WHIRL=build/whirl sh tests/run.sh build/tests/log $(RUN_HOST) $(RUN_BOARD) $(RUN_CLI) $(RUN_CHIP) $(RUN_CORE)

##@ Tests and quality
# Parts of the tests, for work on one part.
test-cli: $(GEN)/.stamp ##- the scripts of tests/cli alone
	@$(MAKE) test-programs
	@WHIRL=build/whirl sh tests/run.sh build/tests/log $(RUN_CLI)

test-board: $(GEN)/.stamp ##- the portable suites alone, on the emulated boards that `make test` takes
	+@$(call build_board_tests,$(BOARDS_TEST))
	@sh tests/run.sh build/tests/log $(RUN_BOARD)

# Every board, with the tests that its images contain.
BOARDS_SUITES := $(filter-out $(boards_without_suites),$(BOARDS_ALL))
test-boards-now: $(GEN)/.stamp
	+@$(call build_board_tests,$(BOARDS_SUITES))
	+@$(foreach b,$(BOARDS_ALL),$(call on_board,$(b),image-rules) &&) true
	@TEST_BEGINS=1 TEST_SECONDS=7200 sh tests/run.sh build/tests/log_boards $(foreach b,$(BOARDS_SUITES),$(call run_board,$(b)))

# Generated mechanisms are compared with references of another kind. The seed is printed; if none is given, it is new.
# The suites' figures stay in build/tests/log_properties and are printed at the end.
PROPERTIES ?= 10000
PROPERTY_SUITES := hybrids hard_scales linkages
properties-now: $(GEN)/.stamp
	@$(MAKE) build/tests/host
	@export WHIRL_CASES=$(PROPERTIES) WHIRL_SEED=$(if $(filter file,$(origin SEED)),$$(date +%s),$(SEED)); \
	echo "PROPERTIES=$$WHIRL_CASES SEED=$$WHIRL_SEED"; status=0; \
	TEST_BEGINS=1 TEST_SECONDS=86400 sh tests/run.sh build/tests/log_properties \
	    $(foreach s,$(PROPERTY_SUITES),"random $(s)" "build/tests/host $(s)") || status=1; \
	grep -h '^  ' build/tests/log_properties/*.log; exit $$status

# The flag matrix: code compiled with unusual flags must give the interpreter's bits or be refused.
flags-now: build/whirl
	@WHIRL=build/whirl sh tests/flags.sh

# --- tools --------------------------------------------------------------------------------------
# tool NAME LIBRARIES MORE-FILES: builds tests/tools/NAME.c.
define tool
$(B)/tools/$(1): $(call objects,host,tests/tools/$(1).c $(3)) $(2)
	$$(link)
endef
LIBS_ALL := $(LIB_HOST) $(LIB_FLOAT) $(LIB_DOUBLE)
$(eval $(call tool,functions_exhaustive,$(LIB_FLOAT)))
$(eval $(call tool,tables_exhaustive,$(LIBS_ALL),tests/host/table_check.c))
$(eval $(call tool,long_runs,$(LIBS_ALL),tests/host/motion.c $(UNITY_DIR)/unity.c))
$(eval $(call tool,tel_check))
$(eval $(call tool,mechanisms,$(LIBS_ALL),tests/host/mechanism.c))
$(eval $(call tool,linkages,,tests/host/linkage.c))
$(eval $(call tool,faults,$(LIB_HOST) $(call libraries,float,rig whirl) $(LIB_DOUBLE),tests/host/faults_campaign.c))
# The rig's station in simulated time, on a line of a given speed.
$(B)/tools/sim_station: $(call objects,float,boards/programs/station.c tests/tools/sim_board.c) \
    $(call libraries,float,station rig virtual whirl scenes)
	$(link)
# A bench for the rig's firmware that was written from docs/dev/pil.md and links no code of the project.
$(B)/tools/rig_bench: $(call objects,host,$(wildcard tests/outside/*.c))
	$(link)

# --- fuzzing ------------------------------------------------------------------------------------
# Each tests/fuzz/x.c defines LLVMFuzzerTestOneInput(). Findings stay in build/fuzz/x.found.
FUZZERS := $(patsubst tests/fuzz/%.c,build/fuzz/%.fuzzer,$(wildcard tests/fuzz/fuzz_*.c))
SANITIZE := address,undefined,float-cast-overflow

FUZZED := $(LIB_HOST) $(call libraries,float,station rig whirl) $(LIB_DOUBLE)
# Fuzzing the readers of lines takes little time, and `make check` does it each time.
FUZZERS_OF_LINES := build/fuzz/fuzz_console.fuzzer build/fuzz/fuzz_wire.fuzzer
$(filter-out $(FUZZERS_OF_LINES),$(FUZZERS)): $(FUZZED)
build/fuzz/fuzz_console.fuzzer: $(call libraries,float,station rig whirl)
build/fuzz/fuzz_wire.fuzzer: $(call objects,host,$(wildcard host/monitor/*.c host/base/*.c host/os/*.c host/os/posix/*.c) $(addprefix host/io/,figure_draw.c gnuplot.c minmax_decimation.c plot.c vcd.c) host/number/decimal.c host/number/functions.c) $(call objects,double,$(wildcard core/function*.c)) $(call libraries,float,whirl)
build/fuzz/%.fuzzer: build/fuzz/host/tests/fuzz/%.o
	$(say) LINK $@
	$(Q)$(CC) $(NATIVE) -fsanitize=fuzzer -o $@ $(filter %.o,$^) \
	    -Wl,--start-group $(filter %.a,$^) -Wl,--end-group -lm

# Replays the stored inputs of the fuzzers, without a fuzzer.
KEPT_INPUTS := $(patsubst tests/fuzz/%.c,$(B)/fuzz/%.kept,$(wildcard tests/fuzz/fuzz_*.c))
$(B)/fuzz/%.kept: $(B)/host/tests/fuzz/%.o $(B)/host/tests/fuzz/kept.o $(FUZZED)
	@mkdir -p $(@D)
	$(link)

kept-now: $(KEPT_INPUTS)
	@sh tests/fuzz/kept.sh $^
FUZZ_BUILD = $(MAKE) B=build/fuzz CC=clang OPT=-O1 EXTRA="-fsanitize=fuzzer-no-link,$(SANITIZE) -fno-sanitize-recover=all"
fuzz-programs: $(FUZZERS)
fuzz-now:
	+@$(FUZZ_BUILD) fuzz-programs
	@sh tests/fuzz.sh $(FUZZ_SECONDS) $(FUZZERS)

# The program and its suites with a call at the head of each block, for `make mutants` (mk/mutants/reach.c), in a copy
# of the tree in which REACHED is set. Generated scenes have no such calls, so a change of the core does not compile
# them again.
ifdef REACHED
$(foreach b,host float double,$(foreach d,core host tests/core tests/host,$(eval $(B)/$(b)/$(d)/%.o: FILE_FLAGS += $(REACHED))))
LINK_EXTRA += $(call objects,host,mk/mutants/reach.c)
reachers-now: $(call objects,host,mk/mutants/reach.c)
	@$(MAKE) $(B)/whirl $(B)/tests/host
endif
