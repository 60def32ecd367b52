# packages.sh: the tools of this family (mk/setup/deps.sh).
want gcc-avr "the AVR gate" have avr-gcc
want avr-libc "its C library, for the gate's own program" have_file /usr/lib/avr/include/avr/io.h
want simavr "the emulated AVR" have simavr
want libsimavr-dev "running AVR programs with their cycles counted" have_file /usr/include/simavr/sim_avr.h
want libelf-dev "the same" have_file /usr/include/libelf.h
