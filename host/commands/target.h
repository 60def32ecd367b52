/* target.h: parsing of the words of commands that work on one scene. */
#ifndef COMMANDS_TARGET_H
#define COMMANDS_TARGET_H

#include "host/commands/load.h"
#include "options.h"

/* Take one of a command's own options, with its value, and advance *at past it; false for another word. *bad: reported.
 */
typedef bool target_take(int count, char **words, int *at, void *options, bool *bad);

/* One of a command's own options, in a table. */
typedef struct own_option {
    const char *word;
    const char **value; /* gets what follows the word; of a bare option, the word */
    int *count;         /* may be repeated: value[] gets all; NULL: may not */
    bool is_bare;
    double *strict; /* of options_strict(), and nothing else */
} own_option;

enum { OWN_OPTIONS_MOST = 24 };

typedef struct target_reader {
    const char *command;
    unsigned groups;         /* of the common options that it takes */
    const own_option *table; /* its own options, one without a word at the end; or NULL, and: */
    const char *const *own;  /* the words of its own options, NULL at the end */
    target_take *take;
    const char *one; /* the kind of target, of which only one is allowed; NULL: a scene */
    bool derives;    /* accepts other targets than scenes: changes the message for a second one */
} target_reader;

/* Take all options, of both kinds, and the only other word: *target, or NULL. False after an error, reported. */
bool target_read(const target_reader *reader, int count, char **words, common_options *common,
                 void *options, const char **target);

/* target_read() for a command that works on scenes and mechanisms, with the groups of its usage; and requires a target.
 */
bool target_ask(const char *command, const char *const *own, target_take *take,
                const command_usage *usage, int count, char **words, common_options *common,
                void *options, const char **target);

/* load() of the named scene, or of the file's only scene, with the common options. */
int target_load(loaded *made, source_model *from, const common_options *common, load_wish wish);

/* Is there a target? Else the usage goes to standard error. */
bool target_is_there(const char *target, const command_usage *usage);

#endif
