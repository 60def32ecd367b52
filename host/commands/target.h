/* target.h: reading the words of a command that works on one scene. */
#ifndef COMMANDS_TARGET_H
#define COMMANDS_TARGET_H

#include "host/commands/load.h"
#include "options.h"

/* Takes one of a command's own options, with its value, and steps *at past it; false when the word at *at is none. *bad:
 * told. */
typedef bool target_take(int count, char **words, int *at, void *options, bool *bad);

typedef struct target_reader {
    const char *command;
    unsigned groups;        /* of the common options that it takes */
    const char *const *own; /* the words of its own options, NULL at the end */
    target_take *take;
    const char *one; /* what there is one of at a time; NULL: a scene */
    bool derives;    /* what is no scene will do, too: another word for a second one */
} target_reader;

/* All options, of both kinds, and the one word that is none: *target, NULL when there is no such word. False when
 * something is wrong: told. */
bool target_read(const target_reader *reader, int count, char **words, common_options *common,
                 void *options, const char **target);

/* target_read() of a command that works on a scene or a mechanism alike, with the groups of its usage; and something was
 * named. */
bool target_ask(const char *command, const char *const *own, target_take *take,
                const command_usage *usage, int count, char **words, common_options *common,
                void *options, const char **target);

/* load() of the named scene, with the common options; of a file with one scene, that one. */
int target_load(loaded *made, source_model *from, const common_options *common, load_wish wish);

/* Was something named? Else the usage goes to standard error. */
bool target_is_there(const char *target, const command_usage *usage);

#endif
