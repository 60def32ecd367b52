# curves.mk: what accuracy costs (`make price`): docs/price.md, docs/dev/fronts.md, their charts.

CURVES := build/curves
# Every method, on every board. SCENE+4s: of that motion the first 4 s, in which it has not yet carried errors far.
CURVE_SCENES ?= two_mass_relative epicyclic_from_rest epicyclic_conserved thomson_a thomson_a+4s thomson_a_conserved rig_fixed \
    driven_hinge_from_rest spherical_flight
# Those that are drawn.
CURVE_CHARTS := epicyclic_from_rest thomson_a thomson_a+4s rig_fixed
# Where fronts are counted: a processor with an FPU and one without. The first chart of all has another beside them.
CURVE_COUNTED := mps2-an386 mps2-an385-m0
CURVE_FIRST := epicyclic_from_rest fronts $(CURVE_COUNTED) atmega328p
# All other scenes: these methods in each number, on a Cortex-M4F.
CURVE_METHODS := heun rk4
CURVE_PAGES := docs/price.md docs/dev/fronts.md
# Operations of `whirl price`, of the scenes above and of each other one; fronts are counted down to this error.
CURVE_EFFORT ?= 1e10
CURVE_EFFORT_OTHERS ?= 1e9
CURVE_FINEST := 1e-9
CURVE_JOBS ?= 2

curve_scenes_all = $$(build/whirl list --as table | tr -d '\r' | awk '$$1 == "scene" { print $$2 }')
curve_others = $$(build/whirl list --as table | tr -d '\r' | awk -v all=" $(CURVE_SCENES) " '$$1 == "scene" && !index(all, " " $$2 " ") { print $$2 }')

.PHONY: price-now price-runs-now price-drawn-now price-pages price-again price-all-now
price-now: price-runs-now
	@$(MAKE) price-drawn-now
	@$(MAKE) price-pages

price-runs-now: build/whirl
	@JOBS=$(CURVE_JOBS) mk/curves/runs.sh $(CURVES)/runs $(CURVE_EFFORT) $(CURVE_SCENES) -- $(BOARDS_PRICED)
	@JOBS=$(CURVE_JOBS) mk/curves/runs.sh $(CURVES)/others $(CURVE_EFFORT_OTHERS) $(curve_others)

price-drawn-now: build/whirl
	@mkdir -p $(FIGURES) docs/figures
	@FINEST=$(CURVE_FINEST) mk/curves/curves.sh $(CURVES)/runs $(FIGURES)/price.csv $(CURVE_SCENES) -- $(BOARDS_PRICED) -- $(CURVE_COUNTED)
	@awk -F, -v OFS=, -v out=$(CURVES)/runs -v counted="$(CURVE_COUNTED)" -f mk/curves/words.awk \
	    -f mk/curves/decades.awk -f mk/curves/published.awk $(FIGURES)/price.csv >docs/figures/price.csv
	@awk -F, -v OFS=, -v methods="$(CURVE_METHODS)" -f mk/curves/words.awk -f mk/curves/decades.awk -f mk/curves/scenes.awk \
	    $$(ls $(CURVES)/runs/*.csv $(CURVES)/others/*.csv | grep -v '[@+]') >docs/figures/price_scenes.csv
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

# Every scene, every setting, every board: rows only.
price-all-now: build/whirl
	@JOBS=$(CURVE_JOBS) mk/curves/runs.sh $(CURVES)/all $(CURVE_EFFORT) $(curve_scenes_all) -- $(BOARDS_PRICED)
	@mkdir -p $(FIGURES)
	@mk/curves/curves.sh $(CURVES)/all $(FIGURES)/price_all.csv $$(cd $(CURVES)/all && ls *.csv | grep -v @ | sed 's/\.csv$$//') -- \
	    $(BOARDS_PRICED) --
	@echo "Every row: $(FIGURES)/price_all.csv"

price-again: build/whirl ##- what docs/figures/price.csv says was counted, once more, from its command lines: SCENES, SOME (minutes)
	@SOME=$(or $(SOME),1) mk/curves/again.sh docs/figures/price.csv $(CURVES)/again $(SCENES)
