/* monitor_options.h: what `whirl monitor` is asked to do. */
#ifndef COMMANDS_MONITOR_OPTIONS_H
#define COMMANDS_MONITOR_OPTIONS_H

#include <stdbool.h>

#include "options.h"

/* What can be written: a file each. */
enum { CSV, VCD, RING, RAW, PLOT, OUTPUTS };

typedef struct monitor_options {
    common_options common;
    const char *port;
    const char *output[OUTPUTS];
    double rate;
    double for_s;
    double baud;
    bool strict;
    bool quiet;
} monitor_options;

extern const command_usage monitor_usage;

/* False when something is wrong with them, or missing: told. The caller forgets o->common. */
bool monitor_options_read(int count, char **words, monitor_options *o);

#endif
