# rules.mk: how a C file becomes an object, in each of the builds.
#
# $(B)/<build>/<path>.o comes from <path>.c. Builds of one configuration:
#   host    the programs of this machine, with libc
#   float   the portable code as boards compute, in single precision
#   double  the portable code as reference, in double precision
# mk/board.mk adds one for the chosen board.

ifeq ($(V),1)
Q :=
say = @:
else
Q := @
# On a terminal, each file's message overwrites the last one. A log has only the programs.
say = @said() { if [ -t 1 ]; then printf '\033[K  %-5s %s\r' "$$@"; elif [ "$$1" = LINK ]; then printf '  %-5s %s\n' "$$@"; fi; }; said
endif

# A long target prints its stages, also into a log.
stage = @[ ! -t 1 ] || printf '\033[K'; echo "$(1)"

comma := ,
WARN := -Wall -Wextra -Wconversion -Wshadow -Wdouble-promotion -Wswitch-enum
# One arithmetic everywhere: no contraction to fused multiply-adds, no -ffast-math.
BASE := -std=c11 -ffp-contract=off -I. $(WARN)
# Line numbers for a backtrace. Variables for a debugger would take a quarter more time: make OPT="-O0 -g".
NATIVE := -g1 $(OPT) $(EXTRA)

FLAGS_host := $(BASE) $(NATIVE) -D_POSIX_C_SOURCE=200809L
FLAGS_float := $(BASE) $(NATIVE) -D_POSIX_C_SOURCE=200809L
FLAGS_double := $(FLAGS_float) -DWH_DOUBLE=1

FORCE:

# need COMMAND: if the tool is missing, stops with advice instead of a shell error.
need = command -v $(firstword $(1)) >/dev/null 2>&1 || \
    { echo "make: '$(firstword $(1))' is missing; 'make deps' installs what Whirl needs." >&2; exit 1; }

# listed FILE WORDS: makes a file with these words, and rewrites it only if they change.
define listed
$(1): FORCE
	@mkdir -p $$(@D)
	@echo '$(2)' | cmp -s - $$@ || echo '$(2)' >$$@
endef

# build NAME COMPILER FLAGS: the rules of one build. Its .flags file changes when the flags do.
define build
$(B)/$(1)/.flags: FORCE
	@mkdir -p $$(@D)
	@$$(call need,$(2))
	@echo '$(2) $(3)' | cmp -s - $$@ || echo '$(2) $(3)' >$$@

$(B)/$(1)/%.o: %.c $(B)/$(1)/.flags
	@mkdir -p $$(@D)
	$$(say) CC $$@
	$$(Q)$(2) $(3) $$(FILE_FLAGS) -MMD -MP -c $$< -o $$@
endef

$(eval $(call build,host,$(CC),$(FLAGS_host)))
$(eval $(call build,float,$(CC),$(FLAGS_float)))
$(eval $(call build,double,$(CC),$(FLAGS_double)))

# objects BUILD FILES: the paths of these files' objects.
objects = $(patsubst %.c,$(B)/$(1)/%.o,$(2))

# library ARCHIVE OBJECTS: the archive is always made as a whole, so that files may join or leave.
define library
$(1): $(2) $(1:.a=.list)
	$$(say) AR $$@
	$$(Q)rm -f $$@ && $$(AR) rcs $$@ $$(filter %.o,$$^)
$(call listed,$(1:.a=.list),$(2))
endef

# The program and the firmware need no mathematical library. Tests and tools compare results with one.
LIBM = $(if $(filter $(B)/tests/% $(B)/tools/%,$@),-lm)
# The linker for WebAssembly searches all archives without groups, and does not know groups.
GROUP := $(if $(filter none,$(SYSTEM)),,-Wl$(comma)--start-group)
GROUP_END := $(if $(filter none,$(SYSTEM)),,-Wl$(comma)--end-group)

define link
	$(say) LINK $@
	@mkdir -p $(@D)
	$(Q)$(CC) $(NATIVE) $(LINK_EXTRA) -o $@ $(filter %.o,$^) $(GROUP) $(filter %.a,$^) $(GROUP_END) $(LIBM)
endef

# Generated C: the built-in models and scenes.
GEN := build/gen

# C files that belong to Whirl, for the gates. The lists follow the folders by themselves.
CORE_C := $(wildcard core/*.c)
RIG_C := $(wildcard core/rig/*.c)
STATION_C := $(wildcard core/station/*.c)
VIRTUAL_C := $(wildcard hal/virtual/*.c)
FRAMES_C := $(wildcard hal/pil/*.c)
PORTABLE_C := $(CORE_C) $(RIG_C) $(STATION_C) $(VIRTUAL_C) $(FRAMES_C)
PROGRAM_C := $(wildcard boards/programs/*.c)
BOARD_C := $(wildcard boards/*/*.c)
HOST_TOOL_C := $(wildcard mk/*/*.c boards/*/run/*.c)
WHIRL_MAIN_C := $(wildcard host/*.c)
# Code for an operating system, or its replacement.
WHIRL_C := $(wildcard host/*/*.c host/os/$(or $(SYSTEM),posix)/*.c)
TEST_C := $(wildcard tests/*.c tests/*/*.c)
C_FILES := $(sort $(PORTABLE_C) $(BOARD_C) $(HOST_TOOL_C) $(WHIRL_MAIN_C) $(WHIRL_C) $(TEST_C) \
    $(wildcard core/*.h core/*/*.h hal/*.h hal/*/*.h boards/*.h boards/*/*.h host/*.h host/*/*.h host/os/*/*.c \
    tests/*.h tests/*/*.h))

-include $(wildcard $(foreach b,host float double, \
    $(patsubst %.c,$(B)/$(b)/%.d,$(filter %.c,$(C_FILES)) $(wildcard $(GEN)/*.c $(B)/tests/*.c))))
