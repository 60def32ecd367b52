# stability.mk: what docs/stability.md shows of runs: each script of mk/stability renews its part of it.

STABILITY_SCRIPTS := $(sort $(wildcard mk/stability/*.sh))

.PHONY: stability-now
stability-now: build/whirl
	@$(call need,gnuplot)
	@for script in $(STABILITY_SCRIPTS); do sh $$script build/whirl docs || exit 1; done
