/* options.h: parsing of the command line. */
#ifndef CLI_OPTIONS_H
#define CLI_OPTIONS_H

#include <stdbool.h>
#include <stdio.h>

#include "host/cli/load.h"
#include "host/engine/engine.h"

/* X(id, word, value, group, description): options of several commands, in the order of help texts. Descriptions are
 * broken into lines; those of methods come from core/method.h. */
#define OPTION_ROWS(X) \
    X(OPTION_SET, "--set", "NAME=EXPR", OPTIONS_CHANGE, \
      "a new value for a parameter or an input (repeatable, each name once). A bare number is " \
      "refused if the declared unit is not SI. Parameters of effects need --with.") \
    X(OPTION_START, "--start", "NAME=EXPR", OPTIONS_CHANGE, \
      "a start value: --start \"theta'=330 [rpm]\" (repeatable)") \
    X(OPTION_WITH, "--with", "E,...", OPTIONS_CHANGE, \
      "effects to add; ledger: the balance of energy and momentum; all: every effect but " \
      "the ledger, applied first: `--without all --with drag` selects only drag.") \
    X(OPTION_WITHOUT, "--without", "E,...", OPTIONS_CHANGE, \
      "effects to leave out; all: every effect; conserve: integrate the coordinates in the " \
      "scene's `conserve`, too") \
    X(OPTION_STEP, "--step", "1ms", OPTIONS_STEP, "the fixed step") \
    X(OPTION_UNTIL, "--until", "9s", OPTIONS_CHANGE, \
      "the end of the run, rounded to a whole number of steps; 0: no step") \
    X(OPTION_METHOD, "--method", "M", OPTIONS_ENGINE, "") \
    X(OPTION_NUMBER, "--number", "N", OPTIONS_NUMBER, \
      "double (default, the reference) or float (the same bits as on boards); fixed, for " \
      "`whirl run` and `whirl derive --as c`: 32-bit integers, for smooth mechanisms on " \
      "chips without an FPU; the C code computes the same bits") \
    X(OPTION_COMPENSATED, "--compensated", "", OPTIONS_ENGINE, \
      "compensated sums, which carry the round-off into the next step") \
    X(OPTION_STABILIZED, "--stabilized", "", OPTIONS_ENGINE, \
      "scale the rates in each step to remove up to 1/1024 of the energy drift: for very long " \
      "runs without drive and damping. Adds the ledger.") \
    X(OPTION_ANGLES, "--angles", "A", OPTIONS_ENGINE, \
      "turned (default): look up sines once a step and rotate them at the stages; lookup: " \
      "look up the sines of each stage, if angles change by up to half a turn in a step") \
    X(OPTION_MATRIX, "--matrix", "M", OPTIONS_ENGINE, \
      "compute a whole step as one product with a constant matrix, for a linear mechanism " \
      "without events. exact: the exact motion, with inputs constant over the step; rk4: " \
      "the step of RK4; none (default): use --method") \
    X(OPTION_TABLES, "--tables", "T", OPTIONS_ENGINE, \
      "look up functions of one turn angle in tables in flash, instead of sines and " \
      "divisions. linear: the cheapest without an FPU; cubic: nearly exact; none (default)") \
    X(OPTION_CELLS, "--cells", "N", OPTIONS_ENGINE, \
      "cells of each table: a power of two from 8 to 65536 (default: linear 256, cubic 64)")

#define OPTION_NAME(which, word, value, group, text) which,
typedef enum common_option { OPTION_ROWS(OPTION_NAME) } common_option;
#undef OPTION_NAME
#define OPTION_ONE(which, word, value, group, text) +1
enum { OPTIONS = OPTION_ROWS(OPTION_ONE) };
#undef OPTION_ONE

/* Groups of options, as bits. */
typedef enum option_group {
    OPTIONS_CHANGE = 1, /* changes of an instance */
    OPTIONS_ENGINE = 2, /* the method of integration */
    OPTIONS_NUMBER = 4, /* the number type */
    OPTIONS_STEP = 8,   /* the step, if the command does not choose it */
    OPTIONS_SCENE = 15  /* all groups */
} option_group;

/* A command's help text. */
typedef struct command_usage {
    const char *head;
    unsigned groups;        /* bits of option_group */
    bool described;         /* if false, the help text only names the options */
    const char *tail;       /* or NULL */
    const char *why[EXITS]; /* meaning of each exit status (host/base/exit.h); all NULL: omitted */
} command_usage;

void options_usage(FILE *out, const command_usage *usage);

/* Prints a row of a help text: an option, its value ("": none) and its description. */
void options_describe(FILE *out, const char *word, const char *value, const char *text);

/* If --help or -h is among the words, prints `usage` and returns true. */
bool options_help(int count, char **words, const command_usage *usage);

/* Reads a number from `least` to `most`. For other text, returns false and reports the hint. */
bool options_number(const char *command, const char *option, const char *text, double least,
                    double most, const char *hint, double *number);

/* Reads a time such as 1ms, from 0 to most_s; NULL is 0. For other text, returns false (reported). */
bool options_time(const char *command, const char *option, const char *text, const mechanism *of,
                  double most_s, double *time_s);

/* The range of --effort, a number of operations. */
#define EFFORT_LEAST 1e4
#define EFFORT_MOST 1e15

#define OPTIONS_STRICT_HELP \
    "  --strict=off         exit status 0 even with a warning; without this option it is 1\n" \
    "  --strict=LIMIT       the allowed energy residual, as a part of the balance's largest entry\n"

typedef struct common_options {
    overrides changes; /* --set, --start, --with, --without, --step, --until, --name */
    char **owned;      /* [owned_count] texts in `changes` that options_forget() frees */
    int owned_count;
    image_settings integration; /* --method, --compensated, --stabilized, --angles, --matrix, ... */
    const engine_kind *number;  /* --number: the number type */
} common_options;

common_options options_defaults(void);
void options_forget(common_options *options);

/* Adds --set, and takes ownership of the text. NULL adds nothing. */
void options_set(common_options *options, char *text);

/* If words[*at] is an option of `groups`, stores its value and advances *at. Returns true if a value was found. A
 * wrong, missing or repeated value sets *bad. */
bool options_take(const char *command, unsigned groups, int count, char **words, int *at,
                  common_options *to, bool *bad);

/* True if `word` is `name`, or begins with `name` and "=". */
bool options_is(const char *word, const char *name);
const char *options_value(int count, char **words, int at, const char *name);

/* Is it a name as in a .whirl file, of at most `most` letters? If not, reports it with a hint. */
bool options_is_name(const char *command, const char *name, int most);

/* Prints "whirl COMMAND: error: MESSAGE" on standard error. Returns false. */
bool options_fail(const char *command, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* Is this output, which may be NULL, standard output? */
bool options_is_standard(const char *file);

/* If both --json and --csv write to standard output, reports this and returns false. */
bool options_json_is_alone(const char *command, bool json, const char *csv);

/* The index of the row whose word equals `value`, ignoring case. Each of rows[count] has `size` bytes and begins with
 * its word. If there is none, reports the possible words and returns -1. */
int options_choose(const char *command, const char *what, const char *value, const void *rows,
                   size_t size, int count);

/* === the words of a command =================================================================== */

/* An option's file. An output must differ from all other files of the command, and Whirl must be able to write it. */
typedef enum own_file {
    FILE_NONE,
    FILE_READ,
    FILE_WRITTEN,
    FILE_WRITTEN_LATE, /* written after the work, but checked before it */
    FILE_DRAWN         /* a picture, drawn by gnuplot after the work */
} own_file;

/* Checks a file that is written after the work: returns false (reported) if it cannot be written. NULL is allowed. */
bool options_can_write(const char *command, const char *option, own_file kind, const char *file);

/* An option of one command. Exactly one of text, number, strict and flag is set. */
typedef struct own_option {
    const char *word;
    const char **text; /* gets the value as typed */
    own_file file;     /* the kind of file that the text names */
    int *count;        /* repeatable option: number of values in text[] */
    int limit;         /* most values; 0: no limit */
    double *number;    /* gets the value as a number from `least` to `most` */
    double least, most;
    bool whole; /* the number must be whole */
    const char *hint;
    double *strict; /* gets the limit of --strict, --strict=off or --strict=LIMIT */
    bool *flag;     /* set by an option without a value */
    bool is_bare;   /* the option has no value: *text is set to the option's word */
} own_option;

/* Initializers of own_option, with `to` as the variable that gets the number. */
#define OWN_NUMBER(name, to, from, up_to, such_as) \
    { .word = name, .number = &(to), .least = from, .most = up_to, .hint = such_as }
#define OWN_WHOLE(name, to, from, up_to, such_as) \
    { .word = name, .number = &(to), .least = from, .most = up_to, .hint = such_as, .whole = true }
#define OWN_TOLERANCE(to) \
    OWN_NUMBER("--tolerance", to, 1e-15, 1.0, \
               "a fraction of each coordinate's range: --tolerance 1e-3")
#define OWN_EFFORT(to, such_as) \
    OWN_NUMBER("--effort", to, EFFORT_LEAST, EFFORT_MOST, "operations: --effort " such_as)

typedef struct target_reader {
    const char *command;
    const command_usage *usage; /* also has the groups of common options */
    const own_option *table;    /* own options, ended by a row without a word; or NULL */
    char **many;                /* gets all targets, if the command takes several; else NULL */
    int *many_count;
    char **passed; /* gets the words of common options, to pass to `whirl run`; or NULL */
    int *passed_count;
    const char *one; /* what a target is called in messages; NULL: "scene" */
    bool none;       /* the command may have no target */
    /* target_command() calls work_on() with the opened target, or work() if work_on is NULL. Returns an exit status. */
    int (*work_on)(source_model *from, void *options);
    int (*work)(void *options);
} target_reader;

/* Takes all options, and checks the files that they name. *target: the last target, or NULL if none is given.
 * Returns false after an error (reported). `common` may be NULL if the command has no common options. */
bool target_read(const target_reader *reader, int count, char **words, common_options *common,
                 const char **target);

/* Loads the scene or mechanism of source_pick(), with `prefer_scene` true if request.scene is true or the file has one
 * scene. Returns an exit status (reported). */
int target_load(loaded *made, source_model *from, const common_options *common,
                load_request request);

/* Prints the help text, or reads the words and calls work_on() or work(). Frees `common`. Returns an exit status. */
int target_command(const target_reader *reader, int count, char **words, common_options *common,
                   void *options, const char **target);

#endif
