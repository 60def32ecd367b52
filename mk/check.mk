# check.mk: the quality gates of `make check`; each is a target gate-NAME. tests/gates.sh runs them, stores their
# output in build/check/NAME.log and prints a line for each. Gates joined by a plus sign run at the same time.
GATES := house gcc clang format cppcheck tidy long sanitizers memcheck bad-input fuzz firmware size boards$(FAMILY_GATES:%=+%)
GATES += libm hashes+flashed hosts docs
LINT_FLAGS := -std=c11 $(WARN) -I. $(UNITY_FLAGS) -D_POSIX_C_SOURCE=200809L

check-now: $(GEN)/.stamp
	@sh tests/gates.sh build/check "$(MAKE)" $(GATES)

##@ Tests and quality
##- gate-NAME: one quality gate alone; `make check` names them

gate-house:
	@sh tests/house.sh
	@sh tests/weight.sh
	@sh tests/english.sh

# --- warnings are errors, with both compilers, in every build -------------------------------------
# Files compiled for boards only; a board's own make lints them (tidy-board).
TARGET_C := $(filter-out boards/programs/% boards/host/%,$(BOARD_C))
PC_BOARD_C := $(PROGRAM_C) $(wildcard boards/host/*.c)

TESTS_C := $(HOST_TEST_C) $(wildcard tests/tools/*.c tests/outside/*.c tests/fuzz/*.c)
test-objects: $(call objects,host,$(TESTS_C)) $(call objects,chip,$(CHIP_TEST_C)) \
    $(call objects,float,$(CORE_TEST_C)) $(call objects,double,$(CORE_TEST_C) $(SCENE_C))
objects: $(call objects,host,$(WHIRL_MAIN_C) $(WHIRL_C) $(GEN)/builtin_models.c $(HOST_TOOL_C)) \
    $(foreach b,$(CHIP_BOARDS),$(call objects,chip_$(b),$(CHIP_DRIVERS_C))) \
    $(call objects,float,$(PORTABLE_C) $(PC_BOARD_C) $(SCENE_C)) \
    $(call objects,double,$(CORE_C) $(RIG_C) $(STATION_C))
board-objects: board-own-objects $(call objects,$(BOARD),$(PORTABLE_C) $(PROGRAM_C) $(CORE_TEST_C) $(SCENE_C))
board-own-objects: $(call objects,$(BOARD),$(BOARD_OWN_C)) $(call objects,$(FLASHED),$(BOARD_FLASHED_C))

# If the main configuration has these settings, as in CI (.ci/run), its objects are used. Other gates use the objects of
# these two.
STRICT := EXTRA=-Werror BOARD_EXTRA=-Werror OPT=-O2
GCC_FOLDER := $(if $(filter gcc|-O2|-Werror|-Werror,$(CC)|$(OPT)|$(EXTRA)|$(BOARD_EXTRA)),build,build/check/gcc)
CLANG_FOLDER := build/check/clang
GCC_BUILD = $(MAKE) B=$(GCC_FOLDER) CC=gcc $(STRICT)
CLANG_BUILD = $(MAKE) B=$(CLANG_FOLDER) CC=clang $(STRICT)

gate-gcc: $(GEN)/.stamp
	+@$(GCC_BUILD) -k objects test-objects board-objects
	+@$(foreach b,$(filter-out $(BOARD),$(BOARDS)),$(GCC_BUILD) -k BOARD=$(b) board-own-objects &&) true

# Tests compiled by clang are never run, and clang warns before it optimises, so the syntax pass is enough.
syntax = printf '%s\n' $(1) | xargs -n 8 -P $(JOBS) clang $(LINT_FLAGS) $(2) -Werror -fsyntax-only
gate-clang: $(GEN)/.stamp
	+@$(CLANG_BUILD) -k objects
	@$(call syntax,$(TESTS_C) $(CORE_TEST_C))
	@$(call syntax,$(CORE_TEST_C) $(SCENE_C),-DWH_DOUBLE=1)
	@$(call syntax,$(CHIP_TEST_C),$(CHIP_FLAGS))

# --- layout and lint ------------------------------------------------------------------------------
gate-format:
	@$(call need,clang-format)
	@clang-format --dry-run -Werror $(C_FILES)

# One process per file keeps two cores busy to the end. The core is also linted as double. The analyzer follows this
# many paths of a function, which takes a fifth of the time of 75000 paths. Of 81 null pointers planted before returns
# of long functions, it misses two that 75000 paths find. `make gate-tidy TIDY_PATHS=` follows all paths.
TIDY_PATHS := -Xclang -analyzer-config -Xclang max-nodes=10000
tidy = printf '%s\n' $(1) | xargs -n 1 -P $(JOBS) sh -c 'clang-tidy --quiet "$$1" -- $(2) $(TIDY_PATHS)' _
CHIP_TIDY_C := $(filter tests/chip/%,$(CHIP_TEST_C)) tests/boards/f405_plant.c
TIDY_C := $(filter-out $(TARGET_C) $(CHIP_TIDY_C),$(filter %.c,$(C_FILES)))
gate-tidy: $(GEN)/.stamp
	@$(call need,clang-tidy)
	@$(call tidy,$(TIDY_C),$(LINT_FLAGS))
	@$(call tidy,$(CHIP_TIDY_C),$(LINT_FLAGS) $(CHIP_FLAGS))
	@$(call tidy,$(CORE_C) $(RIG_C) $(STATION_C),$(LINT_FLAGS) -DWH_DOUBLE=1)
	+@$(foreach b,$(BOARDS),$(call on_board,$(b),tidy-board) &&) true

tidy-board:
	@$(call tidy,$(sort $(BOARD_OWN_C) $(BOARD_FLASHED_C)),$(BOARD_TIDY) $(LINT_FLAGS))

# cppcheck reads the core, HAL and boards, which users compile; the host would take half an hour. clang-tidy reads all
# files.
gate-cppcheck:
	@$(call need,cppcheck)
	@mkdir -p build/check/cppcheck
	@cppcheck --quiet --std=c11 --language=c -j $(JOBS) --error-exitcode=1 --inline-suppr \
	    --cppcheck-build-dir=build/check/cppcheck \
	    --enable=warning,performance,portability --library=posix \
	    --suppressions-list=mk/setup/cppcheck.txt -I. \
	    $(filter core/%.c hal/%.c boards/%.c,$(C_FILES))

# Gates build into the same folders. Gates requested together run one after the other.
ifneq ($(word 2,$(filter gate-%,$(MAKECMDGOALS))),)
.NOTPARALLEL:
endif

# --- tests that `make test` leaves out, to be quick ---------------------------------------------------------
gated = "host suites that make test leaves out$(comma) part $(1) of 2" 'WHIRL_FEW=1 sh tests/each.sh build/tests/host $(2)'
# Scripts of which `make test` runs few cases, because others draw more cases of the same kind or run more built-in
# scenes.
LONG_FEW := $(foreach t,price embed_names faults odd_values trust,tests/cli/$(t).sh)
LONG_SUITES := $(filter-out $(HOST_FULL),$(HOST_GATED))
gate-long: $(GEN)/.stamp
	@$(MAKE) test-programs
	+@$(call build_board_tests,$(BOARDS_TEST))
	@WHIRL=build/whirl TEST_SECONDS=900 sh tests/run.sh build/check/log_long \
	    $(call gated,1,$(wordlist 1,12,$(LONG_SUITES))) $(call gated,2,$(wordlist 13,99,$(LONG_SUITES))) \
	    $(foreach t,$(LONG_FEW),"$(t)$(comma) few cases" "WHIRL_FEW=1 sh $(t)") \
	    $(call run_cli,$(filter-out $(LONG_FEW) $(CLI_FULL),$(CLI_GATED)))

# --- all cases of tests of which `make test` runs few -------------------------------------------------------
# Scripts that read WHIRL_FULL. With `rest` they leave out the cases that `make test` and gate-long run completely.
CLI_ASKS = $(sort $(LONG_FEW) $(shell grep -l WHIRL_FULL $(CLI_TESTS)))
FULL_LIST := build/check/full.list
full_part = "host suites$(comma) all cases$(comma) part $(1) of 6" 'sh tests/each.sh build/tests/host $$(sh tests/part.sh $(FULL_LIST) $(1) 6)'
full-now: $(GEN)/.stamp
	@$(MAKE) test-programs
	+@$(call build_board_tests,$(BOARDS_TEST))
	@mkdir -p $(dir $(FULL_LIST)) && { $(call suites_of,$$(grep -lE "few_or_all|usual_or" tests/host/test_*.c)); printf 'test_%s.c\n' $(HOST_FULL); } | sort -u >$(FULL_LIST)
	@WHIRL_FULL=rest WHIRL=build/whirl TEST_SECONDS=3600 sh tests/run.sh build/check/log_full \
	    $(foreach p,0 1 2 3 4 5,$(call full_part,$(p))) $(call run_cli,$(filter-out $(CLI_FULL),$(CLI_ASKS))) \
	    $(foreach t,$(CLI_FULL),"$(t)" "WHIRL_FULL=1 sh $(t)") $(RUN_BOARD)

# --- sanitizers -----------------------------------------------------------------------------------
# WHIRL_FEW: some cases of every class, because an instrumented program takes six times as long. Scripts that only compile
# generated code, which is not instrumented, run in `make test` alone.
# Generated scenes with contacts take gcc half a minute each when they are optimised and instrumented.
# In double, scenes are linked with tests alone.
$(B)/float/$(GEN)/%.o: FILE_FLAGS = $(SCENE_OPT)
$(B)/double/$(GEN)/%.o: FILE_FLAGS = $(or $(SCENE_OPT),$(LEAST_O2))
# The tests themselves are not the subject: only their arrays are guarded.
ASAN_TEST_OPT := -O0 -fno-sanitize=undefined,float-cast-overflow
# The portable suites include the steps; at -O1 with these checks, gcc takes minutes for a file of all methods.
# Generated scenes have no checks either: the suites and the interpreter run the same core. That halves the
# compilation.
ASAN_SCENE_OPT = $(ASAN_TEST_OPT)
ASAN_BUILD = $(MAKE) MAIN="CC='$(CC)' OPT='$(OPT)' EXTRA='$(EXTRA)'" B=build/asan CC=gcc OPT="-O1 -fno-omit-frame-pointer" SCENE_OPT="$(ASAN_SCENE_OPT)" TEST_OPT="$(ASAN_TEST_OPT)" CORE_TEST_OPT=-O0 \
    EXTRA="-fsanitize=$(SANITIZE) -fno-sanitize-recover=all"

# Scripts that run no instrumented program, or only code that other scripts or suites run, too.
CLI_NOT_ASAN := $(foreach t,boards conclusions docs enclosures families flags foreign fresh headers help map no_libm runners setup structure,tests/cli/$(t).sh)
# Scripts and suites left to `make sanitizers-all`: they derive and step as others do, to compare digits, or they try
# the remedies of many runs.
CLI_LESS_ASAN := $(foreach t,angle_parts carriage command_line commands doc_examples earlier_requests \
    effects_cost_nothing embed_fixed embed_headers embed_names embed_sketch emitted_c faults figures fixed \
    float_range forms full_output measure memory odd_values pil plot plots price price_pages printed_zeros \
    prove recorded_bits recorded_lists settings_bits sizes suites summary swing trust undefined units \
    worst_step_marks,\
    tests/cli/$(t).sh)
HOST_LESS_ASAN := aliasing angle_parts apart arm busy busy_beside c_names choice coarse_tables contact_bound contact_centres contact_curved contact_holds contact_law contact_load contact_moments \
    contact_rest contact_scenes contact_squeezed contact_start contact_together cost counts crossings cures declaration_order describe devices double_functions earlier_requests effect_parts \
    effect_subsets effect_work effects enclosure energy_balance_text energy_integral energy_kept exact_books far_origin far_slopes firstlight fixed_loss fixed_ranges fixed_runs folded folded_numbers \
    force_free forced_swing hard_cases hard_contacts hard_edges hard_origin hybrids ill_conditioned image_rows jumped latex_runs ledger_scenes limits linkages lockin_truth map mass_scales matrix_runs \
    methods octave plant potential_wells price_reference prove_drawn pulse_trains rated reference repeats_truth residual_invariance rounding show show_events slope_truth slow_angles stabilized \
    stabilized_beside swings symmetry tables tape_gauge trajectory trust trust_drawn trust_scenes turned undefined verdict warnings
ASAN_REALS := float
ASAN_LIST = $(B)/tests/asan_suites.list
asan_cli = $(call run_cli,$(filter-out $(CLI_NOT_ASAN) $(CLI_LESS_ASAN),$(1)))
# Files that scripts make belong to the main configuration and need its settings. With the sanitizers' settings, this gate
# and the next would compile them again.
asan-run: $(filter-out $(if $(filter double,$(ASAN_REALS)),,%/core_double) %/price_table,$(TEST_PROGRAMS)) $(B)/tests/quick_suites.list $(B)/whirl
	@mkdir -p build/tests
	@printf 'test_%s.c\n' $(HOST_LESS_ASAN) | grep -vxFf - $(B)/tests/host_suites.list >$(ASAN_LIST)
	@env -u MAKEFLAGS -u MFLAGS -u MAKEOVERRIDES -u B -u SCENE_OPT -u MAIN $(MAIN) \
	    ASAN_OPTIONS="malloc_context_size=5:$$ASAN_OPTIONS" WHIRL_FEW=1 WHIRL=$(B)/whirl TEST_SECONDS=900 \
	    sh tests/run.sh $(B)/tests/log $(call run_host,$(ASAN_LIST)) $(call asan_cli,$(CLI_TESTS)) $(RUN_CHIP) \
	    $(foreach r,$(ASAN_REALS),"portable suites$(comma) $(r)" \
	        "$(B)/tests/core_$(r) $(patsubst tests/core/test_%.c,%,$(filter tests/core/test_%,$(CORE_LESS_C)))")

gate-sanitizers: $(GEN)/.stamp
	@$(MAKE) test-programs
	+@$(ASAN_BUILD) asan-run

sanitizers-all: $(GEN)/.stamp ##- gate-sanitizers with all suites and scripts that run an instrumented program (half an hour)
	+@$(ASAN_BUILD) CLI_LESS_ASAN= HOST_LESS_ASAN= CORE_RUNS= SCENE_OPT=-O0 ASAN_REALS="float double" asan-run

# Finds reads of uninitialized values, which the sanitizers do not detect.
MEMCHECK = valgrind -q --error-exitcode=9
gate-memcheck: test-programs build/whirl
	@$(call need,valgrind)
	$(Q){ for real in float double; do \
	        for suite in scene contact ledger; do echo "$(B)/tests/core_$$real $$suite"; done; \
	        for scene in shuttle_clamped thomson_magnet carriage_stop; do \
	            echo "$(B)/whirl run $$scene --with ledger --number $$real --until 0.5s --quiet"; done; done; \
	    } | xargs -P $(JOBS) -I COMMAND sh -c '$(MEMCHECK) COMMAND'

# Broken files of every kind, and the inputs that fuzzers have found, must be refused with a message.
gate-bad-input:
	+@$(ASAN_BUILD) build/asan/whirl
	@sh tests/bad_input.sh build/asan/whirl
	+@$(ASAN_BUILD) kept-now

# Fuzzes the readers of lines, from the console and from a rig, with new inputs in each run: half a minute each, at
# the same time.
GATE_FUZZ_SECONDS ?= 30
gate-fuzz:
	@$(call need,clang)
	+@$(FUZZ_BUILD) $(FUZZERS_OF_LINES)
	@printf '%s\n' $(FUZZERS_OF_LINES) | xargs -n 1 -P $(JOBS) sh tests/fuzz.sh $(GATE_FUZZ_SECONDS)

# --- firmware -------------------------------------------------------------------------------------
# No heap, no libm, no double arithmetic and no recursion in any image's symbols.
gate-firmware:
	@for board in $(BOARDS); do $(MAKE) B=build BOARD=$$board image-rules || exit 1; done
image-rules: board-images $(PIL_IMAGES) $(LIGHT_IMAGE)
	@NM=$(BOARD_NM) OBJDUMP=$(BOARD_OBJDUMP) FLASHED="$(FLASHED_IMAGES) $(if $(BOARD_FLASHED),$(LIGHT))" UNDRIVEN="$(LIGHT)" \
	    sh boards/check_image.sh $(IMAGES) $(PIL_IMAGES) $(LIGHT_IMAGE)

# Boards with hardware of their own. Each flashed image must follow these rules; it is compiled and linted, and its
# bytes and stack are limited. One of them runs few cases in the emulator; its control steps are longer than those of
# mps2-an386.
gate-flashed: $(GEN)/.stamp
	+@$(foreach b,$(boards_flashed),$(call on_board,$(b),BOARD_EXTRA=-Werror flashed-rules tidy-board) &&) true
	+@$(call on_board,netduinoplus2,BOARD_EXTRA=-Werror flashed-tests)
	@sh tests/boards/f405.sh 3 6
	+@$(call on_board,netduinoplus2,BOARD_EXTRA=-Werror rig-steps-now)
	+@for board in $(filter-out $(BOARDS_SINGLE),$(boards_flashed)); do sh tests/boards/firstlight.sh $$board || exit 1; done
	+@$(MAKE) -s small-now

# Core, controller and console on this machine, compiled as in flashed images with little flash.
small-now: $(GEN)/.stamp
	@$(MAKE) -s B=build/small EXTRA="-Werror -DWH_SMALL=1" build/small/tests/core_float
	@build/small/tests/core_float >build/small/suites.log || { grep FAIL build/small/suites.log >&2; exit 1; }
	@grep Failures build/small/suites.log
flashed-rules: board-own-objects $(STATION) $(LIGHT_IMAGE)
	@NM=$(BOARD_NM) OBJDUMP=$(BOARD_OBJDUMP) FLASHED="$(STATION) $(LIGHT_IMAGE)" UNDRIVEN="$(LIGHT)" \
	    sh boards/check_image.sh $(STATION) $(LIGHT_IMAGE)
	@mkdir -p $(FIGURES)
	@$(call size_of,$(STATION))
flashed-tests: $(FLASHED_TESTS) $(STATION) $(LIGHT) build/tools/f405

gate-size:
	@for board in $(BOARDS); do $(MAKE) BOARD=$$board size-now || exit 1; done

# No mathematical library: checked unoptimised, so that compilers cannot replace a library function by code of their own.
gate-libm:
	@for cc in gcc clang; do $(MAKE) B=build/libm/$$cc CC=$$cc OPT=-O0 build/libm/$$cc/whirl || exit 1; done
	@sh tests/no_libm.sh build/libm/gcc/whirl build/libm/clang/whirl

# Boards that are not in `make test` run the suites without the rig's runs, and the guard of the stack. mps2-an505 has
# the instructions of the board in `make test`, so its suites are left to `make test-boards`.
BOARDS_CHECKED = $(filter-out mps2-an505 $(BOARDS_TEST) $(boards_without_suites),$(BOARDS))
gate-boards: $(GEN)/.stamp
	+@$(foreach b,$(BOARDS_CHECKED),$(call on_board,$(b),SUITES=less board-tests) &&) true
	@SUITES=less sh tests/run.sh build/check/log_boards $(foreach b,$(BOARDS_CHECKED),$(call run_board,$(b)))

# --- the output shown in the pages --------------------------------------------------------------------
# README's commands need only `make run`; other pages need more.
DOC_PAGES ?= README.md $(sort $(wildcard docs/*.md docs/*/*.md))
docs-programs: $(GEN)/.stamp
	+@$(MAKE) whirl $(B)/firmware
	+@$(call on_board,mps2-an386,pil-images board-images)
	+@$(call on_board,mps2-an385,pil-images)
	+@$(call on_board,netduinoplus2,board-images)

gate-docs: docs-programs
	@for f in $$(sed -n '/^```sh [rs]/,/^```$$/p' README.md | grep -o 'build/[a-z0-9_/.-]*' | sort -u); do \
	    case " build/whirl $(RUN_IMAGES) " in *" $$f "*) ;; *) \
	        echo "error: README.md: make run does not build $$f"; exit 1 ;; esac; done
	@$(MAKE) run-now >build/run.log 2>&1 || { tail -n 5 build/run.log; echo "error: make run fails"; exit 1; }
	@sh tests/docs.sh check $(DOC_PAGES)
	@sh mk/conclusions/table.sh check docs/conclusions.md

docs-all: docs-programs ##- the commands of all pages, also the slow ones, print what stands below them (a quarter of an hour)
	@sh tests/docs.sh slow $(DOC_PAGES)

docs-renew: docs-programs ##- all pages with what their commands print now: DOC_PAGES=docs/pil.md
	@sh tests/docs.sh renew $(DOC_PAGES)
	@for p in commands commands_bench; do sh mk/commands.sh page $$p >build/$$p.md && cp build/$$p.md docs/$$p.md || exit 1; done

# --- one arithmetic everywhere ----------------------------------------------------------------------
# Boards in the gate, and in `make hashes-all`.
HASH_BUILDS ?= gcc-O0 gcc-O2 clang-O2 clang-O3
HASH_BUILDS_ALL := gcc-O0 gcc-O2 gcc-O3 clang-O0 clang-O2 clang-O3
# Programs built by this machine's compilers whose hashes are compared; the warning gates provide their objects.
HASHED ?= scenes
hash_folder = $(or $(hash_folder_$(1)),build/hash/$(1))
hash_folder_gcc-O2 := $(GCC_FOLDER)
hash_folder_clang-O2 := $(CLANG_FOLDER)
hash_make = $(or $(hash_make_$(1)),$(MAKE) B=build/hash/$(1) CC=$(firstword $(subst -, ,$(1))) OPT=-$(lastword $(subst -, ,$(1))))
hash_make_gcc-O2 = $(GCC_BUILD)
hash_make_clang-O2 = $(CLANG_BUILD)
$(addprefix hash-,$(HASH_BUILDS_ALL)): hash-%:
	+@$(call hash_make,$*) $(HASHED:scenes%=$(call hash_folder,$*)/scenes%)
# Compares the scenes' last states on the boards $(1), of the interpreter, and of this machine's builds: builds the
# images, then runs them.
build_hashes = $(MAKE) $(addprefix hash-,$(HASH_BUILDS)) && $(foreach b,$(1),$(call on_board,$(b),board-images) &&) true
compare_hashes = sh tests/hashes.sh build/hash "the interpreter" "build/whirl hashes" \
    $(foreach h,$(HASH_BUILDS),$(h) $(call hash_folder,$(h))/scenes) \
    $(foreach b,$(1),"$(b)" "$(call on_board,$(b),print-hashes)")
# Compares linear scenes, whose step is one matrix, on the boards $(1).
compare_matrix_hashes = sh tests/hashes.sh build/hash/matrix "the interpreter" "sh tests/matrix_hashes.sh $(MATRIX)" \
    "this machine" build/scenes_matrix $(foreach b,$(1),"$(b)" "$(call on_board,$(b),print-matrix-hashes)")

.PHONY: $(addprefix hash-,$(HASH_BUILDS_ALL))
hashes-now: $(GEN)/.stamp
	+@$(call build_hashes,$(BOARDS))
	@$(MAKE) hash-host-wasm
	@$(call compare_hashes,$(BOARDS)) $(call hash_hosts,wasm)
	@$(MAKE) hashes-matrix
	@$(MAKE) hashes-hard
	@$(MAKE) hashes-settings SETTINGS=some

# In the gate one board runs the scenes to their ends. The others run only the first steps, which show a different
# arithmetic. `make hashes` runs all. The settings run on a board with an FPU and on one without.
BOARDS_FIRST = $(filter-out $(BOARDS_TEST),$(BOARDS))
BOARDS_KINDS = $(BOARDS_TEST) $(filter %-an385 rv32%fc,$(BOARDS))
gate-hashes: $(GEN)/.stamp
	+@$(call build_hashes,$(BOARDS_TEST))
	+@$(foreach b,$(BOARDS_FIRST),$(call on_board,$(b),short-images) &&) true
	@$(MAKE) hash-host-wasm build/scenes_short
	@$(call compare_hashes,$(BOARDS_TEST)) $(call hash_hosts,wasm) \
	    -- "The first $(SINGLE_STEPS) steps:" "this machine" build/scenes_short \
	    $(foreach b,$(BOARDS_FIRST),"$(b)" "$(call on_board,$(b),print-short-hashes)")
	@$(MAKE) hashes-matrix HASH_BOARDS="$(BOARDS_KINDS)"
	@$(MAKE) hashes-hard HARD_BUILDS="gcc-O0 clang-O2" HARD_BOARDS="$(BOARDS_KINDS)"
	@$(MAKE) hashes-settings SETTINGS=some SETTINGS_BUILDS=clang-O2 SETTINGS_BOARDS="$(BOARDS_TEST) mps2-an385"
# HASH_BOARDS="mps2-an386" limits the boards.
HASH_BOARDS ?= $(BOARDS)
hashes-matrix: $(GEN)/.stamp ##- the same bits on every board of linear scenes, a step as one matrix (minutes)
	@$(MAKE) build/scenes_matrix
	@$(call compare_matrix_hashes,$(HASH_BOARDS))

# Processors that are not boards but must give the same bits: qemu-user and node run this machine's program, built for them
# (mk/hosts.mk).
HASH_HOSTS := aarch64 wasm
hash_hosts = $(foreach h,$(1),"$(h)" "$(host_run_$(h)) build/hosts/$(h)/scenes")
.PHONY: $(addprefix hash-host-,$(HASH_HOSTS))
$(addprefix hash-host-,$(HASH_HOSTS)): hash-host-%:
	@$(call host_needs,$*)
	@$(call host_make,$*) $(HASHED:scenes%=build/hosts/$*/scenes%)

# Every board. A board with one image per scene makes few steps, and is compared with this machine's program with as
# many.
BOARDS_WHOLE := $(filter-out $(BOARDS_SINGLE),$(BOARDS_ALL))
hashes-all-now: $(GEN)/.stamp
	+@$(call build_hashes,$(BOARDS_ALL))
	@$(MAKE) build/scenes_short $(addprefix hash-host-,$(HASH_HOSTS))
	@HASH_SECONDS=7200 $(call compare_hashes,$(BOARDS_WHOLE)) \
	    $(call hash_hosts,$(HASH_HOSTS)) \
	    -- "The first $(SINGLE_STEPS) steps:" "this machine" build/scenes_short \
	    $(foreach b,$(BOARDS_SINGLE),"$(b)" "$(call on_board,$(b),print-hashes)")
	@$(MAKE) hashes-hard HARD_BOARDS="$(BOARDS_ALL)" HARD_HOSTS="$(HASH_HOSTS)" HARD_BUILDS="$(HASH_BUILDS)"

$(B)/scenes_short: boards/programs/scenes.c $(call objects,float,boards/host/board.c) $(call libraries,float,scenes whirl)
	$(say) LINK $@
	$(Q)$(CC) $(FLAGS_float) -DSCENE_STEPS_MOST=$(SINGLE_STEPS)U -o $@ $(filter %.c %.o,$^) $(filter %.a,$^)
