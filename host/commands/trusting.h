/* trusting.h: the common part of `whirl trust` and `whirl run`: the scene's image for the finer run beside it. */
#ifndef COMMANDS_TRUSTING_H
#define COMMANDS_TRUSTING_H

#include "host/commands/load.h"
#include "host/run/horizon.h"
#include "host/run/simulate.h"

/* The data that load() must store for trusting_plain(). */
load_keep trusting_keep(const image_settings *settings);
/* The image of twins_plain(), to be freed. NULL: it is the image itself. */
image *trusting_plain(const loaded *made);

#endif
