# Whirl: energies in, firmware out. `make` lists the targets; the rules are in mk/.
#
# V=1 shows the commands. Nothing is written outside build/, with these exceptions: `make figures-docs`, `make price`,
# `make bench-boards`, `make price-table` and `make stability` renew their part of docs/, and `make too-large` lists the
# programs that do not fit into a board.

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.SUFFIXES:
MAKEFLAGS += --no-builtin-rules --no-print-directory
SHELL := /bin/sh
export LC_ALL := C

# --- settings, for the command line -----------------------------------------------------------
ifeq ($(origin CC),default)
CC := gcc
endif
ifeq ($(origin AR),default)
AR := ar
endif
OPT ?= -O2
# Extra compiler and linker flags, such as -Werror or -fsanitize=address.
EXTRA ?=
# The board of emulate and size: a folder of boards/ with a board.mk.
BOARD ?= mps2-an386
# A checkout of the Unity test framework, instead of Debian's copy.
UNITY ?=
# Seconds of each fuzzer.
FUZZ_SECONDS ?= 20
# The folder for the objects of one configuration. The quality gates build with other flags in folders of their own.
B ?= build
# Flags for linking only, such as -static.
LINK_EXTRA ?=
# "none" omits the commands that need processes and signals, for hosts without these (WebAssembly).
SYSTEM ?= posix

# Number of jobs at the same time: as many as there are processors, unless make is called with -j.
JOBS ?= $(shell nproc 2>/dev/null || echo 1)
PARALLEL = $(if $(filter -j% --jobserver%,$(MAKEFLAGS)),,-j$(JOBS))

include mk/rules.mk
include mk/whirl.mk
include mk/tests.mk
include mk/board.mk
include mk/firstlight.mk
include mk/price.mk
include mk/curves.mk
include mk/figures.mk
include mk/hosts.mk
include mk/check.mk
include mk/settings.mk
include mk/hard.mk
include mk/rig.mk
include mk/flash.mk

# A target without a slash or a dot in its name is not a file.
.PHONY: FORCE $(shell cat Makefile mk/*.mk | sed -n 's/^\([a-z][a-z0-9 -]*\):\([^=].*\)\{0,1\}$$/\1/p')

##@ Start here

help: ## this list
	@echo "Whirl: write a mechanism's energies, get its motion and its firmware."
	@awk -f mk/help.awk Makefile mk/*.mk
	@echo ""
	@echo "make help-all names the others: campaigns, parts of the tests, the pages' tables."
	@echo "V=1 shows the commands; -j2 uses two cores. BOARD= names a folder of boards/."

help-all: ## all targets, those for authors as well
	@awk -v all=1 -f mk/help.awk Makefile mk/*.mk

deps: ## install the Debian packages that are missing for everything below
	@UNITY="$(UNITY)" CC="$(CC)" mk/setup/deps.sh
	@echo "All packages are there."

run: ## the whole way: a mechanism's energies, its motion, its firmware on an emulated board
	@CC="$(CC)" mk/setup/deps.sh host plot firmware
	@$(MAKE) $(PARALLEL) run-now

rig: ## the rig's firmware on this machine (with BOARD= in its emulator), its rotor a model's, its console for any terminal program
	@CC="$(CC)" mk/setup/deps.sh host $(if $(ASKED_BOARD),$(BOARD_DEPS))
	@$(MAKE) $(PARALLEL) rig-now

pil: ## processor in the loop: the rig's firmware on BOARD against a plant of its own, and its tape everywhere
	@CC="$(CC)" mk/setup/deps.sh host firmware
	@$(MAKE) $(PARALLEL) pil-now

whirl: $(B)/whirl ## the command line program, build/whirl

# Installs the program, and the core, with which generated C is compiled: -I $(PREFIX)/share/whirl.
PREFIX ?= /usr/local
INSTALLED = $(DESTDIR)$(PREFIX)
CORE_ROOMS := core core/contact core/number core/step
install: $(B)/whirl ## the program, its man pages and the core's sources into PREFIX (/usr/local), below DESTDIR
	$(Q)mkdir -p "$(INSTALLED)/bin" "$(INSTALLED)/share/whirl/boards/shared" \
	    $(CORE_ROOMS:%="$(INSTALLED)/share/whirl/%")
	$(Q)install -m 755 $(B)/whirl "$(INSTALLED)/bin/whirl"
	$(Q)WHIRL=$(B)/whirl sh mk/commands.sh man "$(INSTALLED)/share/man/man1"
	$(Q)for room in $(CORE_ROOMS); do install -m 644 $$room/*.[ch] "$(INSTALLED)/share/whirl/$$room" || exit 1; done
	$(Q)install -m 644 boards/shared/mem.c "$(INSTALLED)/share/whirl/boards/shared"
	$(Q)install -m 644 LICENSE README.md "$(INSTALLED)/share/whirl"
uninstall: ## remove what `make install` put there
	$(Q)rm -f "$(INSTALLED)/bin/whirl" "$(INSTALLED)"/share/man/man1/whirl*.1
	$(Q)rm -rf "$(INSTALLED)/share/whirl"
man: $(B)/whirl ##- the man pages into build/man: man -l build/man/whirl-run.1
	$(Q)WHIRL=$(B)/whirl sh mk/commands.sh man $(B)/man

##@ Tests and quality

test: ## the tests, on this machine and on the emulated board (what takes longer: check); ends with "N passed, N failed"
	@UNITY="$(UNITY)" CC="$(CC)" mk/setup/deps.sh host plot firmware tests
	@UNITY="$(UNITY)" mk/setup/unity.sh build/unity
	@$(MAKE) $(PARALLEL) test-now

check: ## the quality gates: warnings, layout, lint, sanitizers, firmware rules, equal bits
	@UNITY="$(UNITY)" CC="$(CC)" mk/setup/deps.sh
	@UNITY="$(UNITY)" mk/setup/unity.sh build/unity
	@$(MAKE) $(PARALLEL) check-now

full: ## all cases of what `make test` and `make check` take fewer of; ends with "N passed, N failed" (most of an hour)
	@UNITY="$(UNITY)" CC="$(CC)" mk/setup/deps.sh
	@UNITY="$(UNITY)" mk/setup/unity.sh build/unity
	@$(MAKE) $(PARALLEL) full-now

hashes: ## the same bits from every compiler, optimisation level, board and the interpreter
	@CC="$(CC)" mk/setup/deps.sh host firmware boards quality
	@$(MAKE) hashes-now

hashes-all: ##- the same bits on every board there is, on AArch64 and in WebAssembly (half an hour)
	@CC="$(CC)" mk/setup/deps.sh host firmware boards quality hosts
	@$(MAKE) HASH_BUILDS="$(HASH_BUILDS_ALL)" hashes-all-now

test-boards: ## the portable suites, the stack's guard and the firmware rules on every board (half an hour)
	@UNITY="$(UNITY)" CC="$(CC)" mk/setup/deps.sh host firmware boards tests
	@UNITY="$(UNITY)" mk/setup/unity.sh build/unity
	@$(MAKE) test-boards-now

hosts: ## the same generated code from whirl built by other compilers, C libraries and processors (minutes)
	@CC="$(CC)" mk/setup/deps.sh host quality hosts
	@$(MAKE) hosts-now

flags: ## other people's compiler flags: the same bits or a refusal (a minute or two)
	@CC="$(CC)" mk/setup/deps.sh host firmware quality
	@$(MAKE) flags-now

mutants: ##- small changes of the code, and whether the tests notice: MUTANTS, SEED, FOLDERS (an hour or two)
	@UNITY="$(UNITY)" CC="$(CC)" mk/setup/deps.sh host plot tests
	@UNITY="$(UNITY)" mk/setup/unity.sh build/unity
	@MAKE="$(MAKE)" sh mk/mutants/mutants.sh

properties: ##- random linkages and hybrids against their energies in numbers: PROPERTIES of each, SEED (10,000: two hours on two cores)
	@UNITY="$(UNITY)" CC="$(CC)" mk/setup/deps.sh host tests
	@UNITY="$(UNITY)" mk/setup/unity.sh build/unity
	@$(MAKE) properties-now

rig-truth: ##- the rig's measurement against the truth, its intervals against 1,000 noisy runs of each kind (a minute)
	@UNITY="$(UNITY)" CC="$(CC)" mk/setup/deps.sh host tests
	@UNITY="$(UNITY)" mk/setup/unity.sh build/unity
	@$(MAKE) $(PARALLEL) rig-truth-now

faults: ##- the rig's controller against faults of plant and links: RUNS (20,000: half an hour; with BOARD= in its emulator 2,000), SEED
	@CC="$(CC)" mk/setup/deps.sh host $(if $(ASKED_BOARD),firmware boards)
	@$(MAKE) $(PARALLEL) faults-now

sine-exhaustive: $(B)/tools/functions_exhaustive ##- the sine's worst error, over all 2^32 angles (minutes)
	$(Q)$< 1 sine && $< 1 cosine

functions-exhaustive: $(B)/tools/functions_exhaustive ##- the float functions' worst errors, over all 2^32 floats (half an hour at most)
	$(Q)$<

long-runs: $(B)/tools/long_runs ##- energies and a centre of mass over LONG_STEPS steps, 10^8 when left out (an hour)
	$(Q)$< $(or $(LONG_STEPS),1e8)

tables-exhaustive: $(B)/tools/tables_exhaustive ##- tables of --tables against their functions, over all 2^32 phases (a quarter of an hour)
	$(Q)$<

fuzz: ##- broken files at the parser, odd mechanisms at the rest, for FUZZ_SECONDS each
	@CC="$(CC)" mk/setup/deps.sh host quality
	@$(MAKE) fuzz-now

format: ##- lay out every C file as .clang-format says
	@CC="$(CC)" mk/setup/deps.sh quality
	$(Q)clang-format -i $(C_FILES)

##@ Price

price: ## what accuracy costs: error against cycles of eight scenes on every board, fronts counted; into docs/ (a quarter of an hour)
	@CC="$(CC)" mk/setup/deps.sh host plot firmware boards quality bench
	@$(MAKE) price-now

bench: ## instructions a step, counted, on this machine and on the emulated boards
	@CC="$(CC)" mk/setup/deps.sh host firmware bench
	@$(MAKE) bench-now

bench-boards: ##- a step of five scenes on every board: instructions, cycles, bytes; into docs/dev/price.md (minutes)
	@CC="$(CC)" mk/setup/deps.sh host firmware boards quality
	@$(MAKE) bench-boards-now

price-rows: ##- steps of a hundred scenes counted on every board: build/cost/rows.csv, for price-table (half an hour)
	@CC="$(CC)" mk/setup/deps.sh host firmware boards quality bench
	@$(MAKE) price-rows-now

worst-step: ## the most instructions of a step with events, over a million random steps a scene (minutes)
	@CC="$(CC)" mk/setup/deps.sh host firmware bench
	@$(MAKE) worst-now

rig-steps: ##- instructions that a control step of the rig takes on BOARD, at most RIG_STEP_MOST (a minute)
	@CC="$(CC)" mk/setup/deps.sh host firmware bench
	@$(MAKE) rig-steps-now

size: ## bytes of flash, of memory and of stack of BOARD's images, and of the functions
	@CC="$(CC)" mk/setup/deps.sh host $(BOARD_DEPS)
	@$(MAKE) size-now

##@ The dissertation

figures: ## the dissertation's figures and the findings' plots, in build/figures
	@CC="$(CC)" mk/setup/deps.sh host plot
	@$(MAKE) figures-now

conclusions: ## the dissertation's claims beside Whirl's numbers, with a verdict each (a minute)
	@CC="$(CC)" mk/setup/deps.sh host
	@$(MAKE) conclusions-now

stability: ##- the plots of docs/hard_cases.md and the maps of docs/stability.md, anew (minutes)
	@CC="$(CC)" mk/setup/deps.sh host plot
	@$(MAKE) stability-now

##@ Boards

emulate: ## run BOARD's firmware in the emulator
	@CC="$(CC)" mk/setup/deps.sh host $(BOARD_DEPS)
	@$(MAKE) emulate-now

too-large: ##- list anew what does not fit into BOARD, one with small memory (many minutes)
	@CC="$(CC)" mk/setup/deps.sh host $(BOARD_DEPS)
	@$(MAKE) whirl
	@$(MAKE) $(GEN)/.stamp
	@$(MAKE) too-large-now

##@ Cleaning

clean: ## remove what was built, except the fetched test framework
	$(Q)[ ! -d build ] || find build -mindepth 1 -maxdepth 1 ! -name unity -exec rm -rf {} +

distclean: ##- remove build/ altogether
	$(Q)rm -rf build
