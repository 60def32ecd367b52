# family.mk: the emulator of this family's programs (simavr, which counts cycles), and its gate.
build/avr_run: boards/avr/run/avr_run.c
	@$(call need,$(CC))
	@mkdir -p $(@D)
	$(say) LINK $@
	$(Q)$(CC) -std=c11 $(WARN) -O2 -o $@ $< -lsimavr -lelf

# --- AVR: tables in flash, and equal bits, in every dialect of C and C++ ---
FAMILY_GATES += avr
.PHONY: gate-avr
gate-avr: build/whirl $(GEN)/.stamp
	@$(call need,avr-gcc)
	@$(call need,simavr)
	@sh tests/embed/avr.sh build/whirl build/check/avr
	@$(MAKE) BOARD=atmega328p build/avr_run
	@sh tests/boards/avr_cycles.sh build/avr_run build/check/avr_cycles
	+@$(call on_board,atmega2560,BOARD_EXTRA=-Werror build/atmega2560/station.elf build/tools/atmega)
	@sh tests/boards/atmega.sh 330 4 6
