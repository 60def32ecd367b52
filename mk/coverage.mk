# coverage.mk: which lines and branches of the core the suites reach: the portable suites in float and double, and suites of
# the program, whose interpreter steps by the core. docs/testing.md says what counts.
#
# Counted are the core's own files and what includes its headers: the portable suites and the interpreter, compiled without
# optimisation, no function inlined (the attribute is taken away: else each of its copies would have conditions of its
# own), those that nobody calls kept, so that they count as not reached. Generated scenes run, but are not counted: in them
# counts and methods are constants, and most conditions are settled when they are compiled.

COVERAGE = build/coverage
COVERAGE_BUILD = $(MAKE) B=$(COVERAGE) CC=gcc OPT=-O2 LINK_EXTRA=--coverage \
    COUNTED="-O0 --coverage -fprofile-update=single -Dalways_inline=unused -fkeep-inline-functions -w"
# The least of each, in per cent.
LINES_LEAST = 0
BRANCHES_LEAST = 0
# Suites of the program: those that step (others take time and reach nothing more).
COVERAGE_SUITES =

ifdef COUNTED
$(foreach b,float double,$(eval $(B)/$(b)/core/%.o $(B)/$(b)/tests/core/%.o: FILE_FLAGS += $(COUNTED)))
$(call objects,host,$(addprefix host/run/,engine_double.c engine_float.c undefined.c)): FILE_FLAGS += $(COUNTED)
endif

##@ Tests and quality
.PHONY: coverage coverage-now
coverage: ## lines and branches of the core that the suites reach (ten minutes)
	@UNITY="$(UNITY)" CC=gcc mk/setup/deps.sh host tests
	@UNITY="$(UNITY)" mk/setup/unity.sh build/unity
	@$(MAKE) coverage-now

coverage-now: $(GEN)/.stamp
	+@$(COVERAGE_BUILD) $(COVERAGE)/tests/core_float $(COVERAGE)/tests/core_double $(COVERAGE)/tests/host
	@LINES_LEAST=$(LINES_LEAST) BRANCHES_LEAST=$(BRANCHES_LEAST) sh mk/coverage/coverage.sh $(COVERAGE) "$(COVERAGE_SUITES)"
