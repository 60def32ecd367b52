/* target.h: parsing of the words of commands that work on one scene. */
#ifndef CLI_TARGET_H
#define CLI_TARGET_H

#include "host/cli/load.h"
#include "options.h"

/* Take one of a command's own options, with its value, and advance *at past it; false for another word. *bad: reported.
 */
typedef bool target_take(int count, char **words, int *at, void *options, bool *bad);

/* One of a command's own options, in a table. What follows its word goes to */
typedef struct own_option {
    const char *word;
    const char **text; /* here; */
    int *count;        /* of a repeatable one, all of it to text[]; */
    double *number;    /* or here, as a number between two bounds, both allowed, */
    double least, most;
    bool whole; /* and a whole one; */
    const char *hint;
    double *strict; /* or as options_strict() takes it. */
    bool *flag;     /* Nothing follows: it is set; */
    bool is_bare;   /* or text gets the word. */
} own_option;

/* Rows: a number, and those that several commands have. */
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
    unsigned groups;         /* of the common options that it takes */
    const own_option *table; /* its own options, one without a word at the end; or NULL */
    target_take *take;       /* of those that are in no table; or NULL */
    const char *const *own;  /* their words, NULL at the end */
    const char *one;         /* what there is one of at a time; NULL: a scene */
    bool derives;            /* what is no scene will do, too: another word for a second one */
} target_reader;

/* Take all options, of both kinds, and the only other word: *target, or NULL. False after an error, reported. */
bool target_read(const target_reader *reader, int count, char **words, common_options *common,
                 void *options, const char **target);

/* load() of the named scene, or of the file's only scene, with the common options. */
int target_load(loaded *made, source_model *from, const common_options *common, load_wish wish);

/* Is there a target? Else the usage goes to standard error. */
bool target_is_there(const char *target, const command_usage *usage);

#endif
