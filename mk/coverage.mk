# coverage.mk: which lines and branches of the core the suites reach: the portable suites in float and double, the
# program's own suites (whose interpreter steps by the core), the scripts that compile generated code not among them.
# Counted by gcc, summed by gcovr: a line of a header counts once, wherever it was compiled in.

COVERAGE = build/coverage
COVERAGE_BUILD = $(MAKE) B=$(COVERAGE) CC=gcc OPT=-O0 EXTRA="--coverage -fprofile-update=single"

##@ Tests and quality
.PHONY: coverage coverage-now
coverage: ## lines and branches of the core that the suites reach (many minutes)
	@UNITY="$(UNITY)" CC=gcc mk/setup/deps.sh host tests coverage
	@UNITY="$(UNITY)" mk/setup/unity.sh build/unity
	@$(MAKE) coverage-now

coverage-now: $(GEN)/.stamp
	+@$(COVERAGE_BUILD) $(COVERAGE)/tests/core_float $(COVERAGE)/tests/core_double $(COVERAGE)/tests/host
	@sh mk/coverage/coverage.sh $(COVERAGE) "$(COVERAGE_SUITES)"
