# coverage.mk: which lines and branches of the core the portable suites reach. docs/dev/testing.md says what counts, and why.
COVERAGE = build/coverage
COVERAGE_BUILD = $(MAKE) B=$(COVERAGE) CC=gcc OPT=-O2 LINK_EXTRA=--coverage \
    COUNTED="-O0 --coverage -fprofile-update=single -Dalways_inline=unused -fkeep-inline-functions -w"
# The required coverage of each, in per cent.
LINES_LEAST = 99
BRANCHES_LEAST = 97

ifdef COUNTED
$(foreach b,float double,$(eval $(B)/$(b)/core/%.o $(B)/$(b)/tests/core/%.o: FILE_FLAGS += $(COUNTED)))
endif

##@ Tests and quality
coverage: ##- lines and branches of the core that the portable suites reach; fails below 99 and 97 per cent (minutes)
	@UNITY="$(UNITY)" CC=gcc mk/setup/deps.sh host tests
	@UNITY="$(UNITY)" mk/setup/unity.sh build/unity
	@$(MAKE) coverage-now

coverage-now: $(GEN)/.stamp
	+@$(COVERAGE_BUILD) $(COVERAGE)/tests/core_float $(COVERAGE)/tests/core_double
	@LINES_LEAST=$(LINES_LEAST) BRANCHES_LEAST=$(BRANCHES_LEAST) sh mk/coverage/coverage.sh $(COVERAGE)

# The program and its suites with a call at the head of each block, for `make mutants` (mk/mutants/reach.c), in a copy of the tree
# where REACHED is set. Generated scenes have none: a change of the core does not compile them anew there.
ifdef REACHED
$(foreach b,host float double,$(foreach d,core host tests/core tests/host,$(eval $(B)/$(b)/$(d)/%.o: FILE_FLAGS += $(REACHED))))
LINK_EXTRA += $(call objects,host,mk/mutants/reach.c)
reachers-now: $(call objects,host,mk/mutants/reach.c)
	@$(MAKE) $(B)/whirl $(B)/tests/host
endif
