/* target.h: parsing of the words of commands that work on one scene. */
#ifndef CLI_TARGET_H
#define CLI_TARGET_H

#include "host/cli/load.h"
#include "options.h"

/* Takes one of a command's own options, with its value, and advances *at past it. Returns false for another word. An
 * error is reported and sets *bad. */
typedef bool target_take(int count, char **words, int *at, void *options, bool *bad);

/* One of a command's own options, in a table. Exactly one of text, number, strict and flag is set. */
typedef struct own_option {
    const char *word;
    const char **text; /* gets the value as typed */
    int *count;        /* number of values in text[], for an option that may be repeated */
    double *number;    /* gets the value as a number from `least` to `most` */
    double least, most;
    bool whole; /* the number must be whole */
    const char *hint;
    double *strict; /* gets the value of options_strict() */
    bool *flag;     /* is set by an option without a value */
    bool is_bare;   /* an option without a value: text gets its word */
} own_option;

/* Rows for numbers, and for options of several commands. */
#define OWN_NUMBER(name, to, from, up_to, such_as) \
    { .word = name, .number = &(to), .least = from, .most = up_to, .hint = such_as }
#define OWN_WHOLE(name, to, from, up_to, such_as) \
    { .word = name, .number = &(to), .least = from, .most = up_to, .hint = such_as, .whole = true }
#define OWN_TOLERANCE(to) \
    OWN_NUMBER("--tolerance", to, 1e-15, 1.0, \
               "a part of the range that a coordinate has: --tolerance 1e-3")
#define OWN_EFFORT(to, such_as) \
    OWN_NUMBER("--effort", to, EFFORT_LEAST, EFFORT_MOST, "operations: --effort " such_as)

enum { OWN_OPTIONS_MOST = 24 };

typedef struct target_reader {
    const char *command;
    const command_usage *usage; /* its groups of common options are accepted */
    const own_option *table;    /* own options, ended by one without a word; or NULL */
    target_take *take;          /* reads own options that are not in the table; or NULL */
    const char *const *own;     /* the words of those options, NULL at the end */
    const char *one; /* word for a target in the message about a second one; NULL: "scene" */
    bool derives;    /* a target may also be a mechanism; that message then says so */
    bool none;       /* the command may have no target */
    /* The work of target_command(), which returns an exit status: on the opened target, or (`work` alone) without it. */
    int (*work_on)(source_model *from, void *options);
    int (*work)(void *options);
} target_reader;

/* Takes all common and own options. *target is the only other word, or NULL. Returns false after an error, which is
 * reported. */
bool target_read(const target_reader *reader, int count, char **words, common_options *common,
                 void *options, const char **target);

/* load() of the named scene, or of the file's only scene, with the common options. */
int target_load(loaded *made, source_model *from, const common_options *common, load_wish wish);

/* A whole command: prints the help text, or takes the words and does the work; the options are then forgotten. Returns an exit
 * status. */
int target_command(const target_reader *reader, int count, char **words, common_options *common,
                   void *options, const char **target);

#endif
