# figures.mk: the dissertation's figures, findings and claims.

FIGS := $(sort $(wildcard mk/figures/fig*.fig))
FINDINGS := $(sort $(wildcard mk/figures/finding_*.fig))

figures-now: build/whirl build/pil_rig build/pil_carriage
	@$(call need,gnuplot)
	@rm -rf $(FIGURES)/data
	@sh mk/figures/figures.sh build/whirl $(FIGURES) $(FIGS) $(FINDINGS)
	@sh mk/figures/page.sh $(FIGS) >$(FIGURES)/figures.md
	@echo "Drawn: $(FIGURES)/*.svg and *.png"

##@ The dissertation
figures-docs: figures ##- the same, copied into docs/
	@mkdir -p docs/figures
	@cp $(patsubst mk/figures/%.fig,$(FIGURES)/%.svg,$(FIGS) $(FINDINGS)) docs/figures/
	@cp $(FIGURES)/figures.md docs/figures.md
	@echo "Copied to docs/figures.md and docs/figures/"

conclusions-now: build/whirl build/firmware
	@sh mk/conclusions/table.sh print
conclusions-renew: build/whirl build/firmware ##- the same, written into docs/conclusions.md
	@sh mk/conclusions/table.sh renew docs/conclusions.md

# Runs shown in docs/hard_cases.md and docs/stability.md. Messages on step, range or angle are the page's subject.
HARD_FIGS := $(sort $(wildcard mk/stability/*.fig))
stability-now: build/whirl
	@$(call need,gnuplot)
	@rm -rf $(FIGURES)/hard && mkdir -p $(FIGURES)/hard docs/figures/hard
	@sh mk/figures/figures.sh build/whirl $(FIGURES)/hard $(HARD_FIGS) 2>$(FIGURES)/hard.said || { cat $(FIGURES)/hard.said >&2; exit 1; }
	@cp $(HARD_FIGS:mk/stability/%.fig=$(FIGURES)/hard/%.svg) docs/figures/hard/
	@sh mk/stability/maps.sh build/whirl docs
