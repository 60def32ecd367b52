# curves.mk: error against cycles (`make price`): docs/price.md, docs/dev/fronts.md and their charts.

CURVES := build/curves
# Every method is run on every board. SCENE+4s is only the first 4 s of a motion, in which errors are still small.
CURVE_SCENES ?= two_mass_relative epicyclic_from_rest epicyclic_conserved thomson_a thomson_a+4s thomson_a_conserved rig_fixed \
    driven_hinge_from_rest spherical_flight
# Scenes with a chart.
CURVE_CHARTS := epicyclic_from_rest thomson_a thomson_a+4s rig_fixed
# Boards with counted fronts: a processor with an FPU and one without. The first chart also shows a third board.
CURVE_COUNTED := mps2-an386 mps2-an385-m0
CURVE_FIRST := epicyclic_from_rest fronts $(CURVE_COUNTED) atmega328p
CURVE_PAGES := docs/price.md docs/dev/fronts.md
# Budget of `whirl price`, in operations; fronts are counted down to this error.
CURVE_EFFORT ?= 1e10
CURVE_FINEST := 1e-9
CURVE_JOBS ?= 2

.PHONY: price-now price-runs-now price-drawn-now price-pages price-again
price-now: price-runs-now
	@$(MAKE) price-drawn-now
	@$(MAKE) price-pages

price-runs-now: build/whirl
	@JOBS=$(CURVE_JOBS) mk/curves/runs.sh $(CURVES)/runs $(CURVE_EFFORT) $(CURVE_SCENES) -- $(BOARDS_PRICED)

price-drawn-now: build/whirl
	@mkdir -p $(FIGURES) docs/figures
	@FINEST=$(CURVE_FINEST) mk/curves/curves.sh $(CURVES)/runs $(FIGURES)/price.csv $(CURVE_SCENES) -- $(BOARDS_PRICED) -- $(CURVE_COUNTED)
	@awk -F, -v OFS=, -v out=$(CURVES)/runs -v counted="$(CURVE_COUNTED)" -f mk/curves/words.awk \
	    -f mk/curves/decades.awk -f mk/curves/published.awk $(FIGURES)/price.csv >docs/figures/price.csv
	@for scene in $(CURVE_CHARTS); do \
	    svg=price_$$(echo $$scene | tr + _).svg; \
	    mk/curves/chart.sh $(FIGURES)/$$svg $(FIGURES)/price.csv $$scene boards $(CURVE_COUNTED) || exit 1; \
	    cp $(FIGURES)/$$svg docs/figures/; done

##@ Price
price-pages: ##- the tables of docs/price.md and docs/dev/fronts.md, anew from docs/figures/price.csv
	@$(call need,gnuplot)
	@mk/curves/pages.sh docs/figures $(CURVE_PAGES)
	@mk/curves/chart.sh $(FIGURES)/price_fronts.svg docs/figures/price.csv $(CURVE_FIRST)
	@cp $(FIGURES)/price_fronts.svg docs/figures/
	@echo "Every row: $(FIGURES)/price.csv. What pages show of it: docs/figures/price.csv and $(CURVE_PAGES)"

price-again: build/whirl ##- what docs/figures/price.csv says was counted, once more, from its command lines: SCENES, SOME (minutes)
	@SOME=$(or $(SOME),1) mk/curves/again.sh docs/figures/price.csv $(CURVES)/again $(SCENES)
