# peers.mk: the same step and the same derivation by other libraries and tools, compared with Whirl's (mk/peers). They are
# Debian's packages; nothing of them is linked into Whirl.

PEERS := whirl plain gsl arkode odeint
PEER_SYSTEMS := epicyclic thomson reduced
# Thomson's device twice for the others: with a sine and a cosine of every angle in its equations, and with those that
# remain after the addition theorems, which somebody has to apply by hand.
PEER_FILE_epicyclic := tests/tools/naive_epicyclic.c
PEER_FILE_thomson := tests/tools/naive_thomson.c
PEER_FILE_reduced := tests/tools/careful_thomson.c
PEER_SCENE_epicyclic := epicyclic_from_rest
PEER_SCENE_thomson := thomson_a
PEER_SCENE_reduced := thomson_a
PEER_LIBS_gsl := -lgsl -lgslcblas
PEER_LIBS_arkode := -lsundials_arkode -lsundials_nvecserial
# The plain one is the program that `make bench` counts.
PEER_PLAIN := -DNAIVE_STEPPER='"naive_rk4.h"'
PEER_PROGRAMS := $(foreach s,$(PEER_SYSTEMS),$(PEERS:%=$(B)/peers/%_$(s)))

# Whirl's own scene may have another step.
build/peers/scene_%.c: build/whirl mk/peers.mk
	@mkdir -p $(@D)
	$(say) GEN $@
	$(Q)build/whirl derive $(PEER_SCENE_$*) --step 1ms --name peer_scene --as c --header $(@:.c=.h) >$@

# peer_program NAME SYSTEM COMPILER MORE-FLAGS
define peer_program
$(B)/peers/$(1)_$(2): $(PEER_FILE_$(2)) tests/tools/naive.h tests/tools/naive_rk4.h mk/peers/whirl.h \
    $(wildcard mk/peers/$(1).h) mk/peers.mk $(B)/host/tests/tools/naive_main.o build/peers/scene_$(2).c \
    $(call libraries,double,whirl)
	@mkdir -p $$(@D)
	$$(say) LINK $$@
	$$(Q)$(3) $(NATIVE) -ffp-contract=off -I. $(4) -c $$< -o $$@.o
	$$(Q)$(CC) -std=c11 $(NATIVE) -ffp-contract=off -I. -DWH_DOUBLE=1 -c build/peers/scene_$(2).c -o $$@_scene.o
	$$(Q)$(if $(filter odeint,$(1)),$(CXX),$(CC)) -o $$@ $$@.o $$@_scene.o \
	    $(B)/host/tests/tools/naive_main.o $(call libraries,double,whirl) $$(PEER_LIBS_$(1)) -lm
endef
$(foreach s,$(PEER_SYSTEMS), \
    $(eval $(call peer_program,plain,$(s),$(CC) -std=c11,$(PEER_PLAIN))) \
    $(eval $(call peer_program,gsl,$(s),$(CC) -std=c11,-DNAIVE_STEPPER='"mk/peers/gsl.h"')) \
    $(eval $(call peer_program,arkode,$(s),$(CC) -std=c11,-DNAIVE_STEPPER='"mk/peers/arkode.h"')) \
    $(eval $(call peer_program,odeint,$(s),$(CXX) -x c++ -std=c++14,-DNAIVE_STEPPER='"mk/peers/odeint.h"')) \
    $(eval $(call peer_program,whirl,$(s),$(CC) -std=c11,-DWH_DOUBLE=1 \
        -DNAIVE_STEPPER='"mk/peers/whirl.h"')))

bench-peers-now: build/whirl $(GEN)/.stamp
	@$(MAKE) $(PEER_PROGRAMS)
	@PEERS="$(PEERS)" SYSTEMS="$(PEER_SYSTEMS)" SCENES="$(foreach s,$(PEER_SYSTEMS),$(PEER_SCENE_$(s)))" \
	    mk/peers/race.sh build/whirl $(B)/peers build/peers.md
	@mk/price/into_page.sh build/peers.md docs/dev/price.md peers
	@cat build/peers.md
