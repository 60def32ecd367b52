# hosts.mk: the output of whirl must not depend on the compiler and the host of its build. Each host's build writes
# the built-in scenes and generated mechanisms. tests/hosts/compare.sh compares them byte by byte.

# Generated mechanisms, and the seed of the first.
MECHANISMS ?= 500
SEED ?= 1

HOSTS := gcc clang gcc-O0 musl m32 aarch64 armhf wasm
# In CI: two builds made by other gates, another C library, and another kind of machine.
HOSTS_CI := gcc-O2 clang-O2 musl wasm
MULTIARCH = $(shell gcc -print-multiarch)

# For each host: its compiler in the table (if the name does not say it), settings of its build, and the command that
# runs it. The warning gates have built two of them (mk/check.mk).
host_is_gcc     = gcc -O1, x86-64
host_is_clang   = clang -O1, x86-64
host_is_gcc-O0  = gcc -O0, x86-64
host_is_gcc-O2  = gcc -O2, x86-64
host_is_clang-O2 = clang -O2, x86-64
host_is_musl    = gcc -O1, x86-64, musl, static
host_is_m32     = gcc -O1 -m32 -msse2 -mfpmath=sse
host_is_aarch64 = gcc -O1, aarch64, static, qemu-aarch64
host_is_armhf   = gcc -O1, armhf, static, qemu-arm
host_is_wasm    = clang -O1, wasm32-wasi, node

host_cc_musl    = musl-gcc
host_cc_m32     = gcc -m32 -msse2 -mfpmath=sse -idirafter /usr/include/$(MULTIARCH)
host_cc_aarch64 = aarch64-linux-gnu-gcc
host_cc_armhf   = arm-linux-gnueabihf-gcc
host_cc_wasm    = clang --target=wasm32-wasi --sysroot=/usr
host_set_gcc-O0 = OPT=-O0
# WebAssembly has no processes and no signals (host/os/none), and its default stack is too small.
host_set_wasm   = SYSTEM=none AR=llvm-ar EXTRA=-D_WASI_EMULATED_SIGNAL LINK_EXTRA=-Wl,-z,stack-size=8388608
host_run_aarch64 = qemu-aarch64
host_run_armhf  = qemu-arm
# Node's fast calls into WASI use freed memory after the program's memory has grown (github.com/nodejs/node, issue 53087).
host_run_wasm   = node --no-warnings --no-turbo-fast-api-calls tests/hosts/wasi.mjs

host_folder = $(or $(hash_folder_$(1)),build/hosts/$(1))
host_cc = $(or $(host_cc_$(1)),$(firstword $(host_is_$(1))))
host_make = $(MAKE) B=$(call host_folder,$(1)) CC="$(call host_cc,$(1))" OPT=-O1 $(host_set_$(1)) \
    $(if $(hash_folder_$(1)),$(STRICT)) $(if $(findstring static,$(host_is_$(1))),LINK_EXTRA=-static)
host_needs = $(call need,$(call host_cc,$(1)))$(if $(host_run_$(1)), && { $(call need,$(host_run_$(1))); })

.PHONY: $(addprefix host-,$(sort $(HOSTS) $(HOSTS_CI)))
hosts-now:
	+@$(MAKE) -j $(JOBS) $(addprefix host-,$(HOSTS))
	@sh tests/hosts/compare.sh build/hosts/out $(foreach h,$(HOSTS),$(h) "$(host_is_$(h))")

# In `make check`: fewer hosts, and fewer mechanisms.
gate-hosts:
	+@$(MAKE) -j $(JOBS) MECHANISMS=40 $(addprefix host-,$(HOSTS_CI))
	@sh tests/hosts/compare.sh build/hosts/out $(foreach h,$(HOSTS_CI),$(h) "$(host_is_$(h))")

# The portable suites on the foreign processors, in float and in double (many minutes: every scene is compiled).
HOSTS_SUITES ?= m32 aarch64 armhf
.PHONY: $(addprefix suites-,$(HOSTS))
##@ Tests and quality
hosts-suites: $(addprefix suites-,$(HOSTS_SUITES)) ##- the portable suites built for other processors, emulated (many minutes)
$(addprefix suites-,$(HOSTS)): suites-%: $(GEN)/.stamp $(UNITY_DIR)/unity.c
	@$(call host_make,$*) build/hosts/$*/tests/core_float build/hosts/$*/tests/core_double
	@sh tests/run.sh build/hosts/$*/log $(foreach r,float double,"$(host_is_$*): portable suites, $(r)" \
	    "$(host_run_$*) build/hosts/$*/tests/core_$(r)")

MECHANISMS_FILE = build/hosts/mechanisms_$(MECHANISMS)_$(SEED).whirl
$(MECHANISMS_FILE): build/tools/mechanisms
	@mkdir -p $(@D)
	$(say) GEN $@
	$(Q)$< $(MECHANISMS) $(SEED) >$@

$(addprefix host-,$(sort $(HOSTS) $(HOSTS_CI))): host-%: $(GEN)/builtin_models.c $(MECHANISMS_FILE)
	@$(call host_needs,$*)
	@$(call host_make,$*) $(call host_folder,$*)/whirl
	$(say) WRITE build/hosts/out/$*
	$(Q)sh tests/hosts/write.sh build/hosts/out/$* $(MECHANISMS_FILE) $(host_run_$*) $(call host_folder,$*)/whirl
