# family.mk: the test of the rig's firmware on an AVR, with the rig simulated at its pins (tests/boards/atmega.sh).
build/tools/atmega: $(call objects,host,$(addprefix tests/tools/,atmega.c board_tests.c atmega_slots.c atmega_states.c mega.c mega_parts.c)) \
    $(call objects,float,$(GEN)/rig_fixed.c) $(call libraries,float,virtual whirl)
	$(say) LINK $@
	@mkdir -p $(@D)
	$(Q)$(CC) $(NATIVE) $(LINK_EXTRA) -o $@ $(filter %.o,$^) $(GROUP) $(filter %.a,$^) $(GROUP_END) -lsimavr -lelf -lm
