/* system.h: services of the operating system. host/os/posix has them all. host/os/none serves machines without such a
 * system: it has no interrupts, temporary files or locks, and it starts no programs. */
#ifndef OS_SYSTEM_H
#define OS_SYSTEM_H

#include <signal.h>
#include <stdbool.h>
#include <stdio.h>

/* Set by the first SIGINT or SIGTERM. A second one ends the program at once. */
extern volatile sig_atomic_t interrupted;

/* Catches interrupts. An interrupted read or write continues, so that no record is cut. */
void interrupts_catch(void);

/* Like interrupts_catch(), but an interrupt, or the loss of the terminal, also ends a wait for another program. */
void interrupts_catch_waiting(void);

/* Call this at the program's start. A write beyond `ulimit -f` then fails like on a full disk. Until
 * interrupts_catch(), an interrupt ends the program with a message. */
void system_begin(void);

/* Seconds of a clock that never goes back. */
double system_now_s(void);

/* Makes a temporary folder; the XXXXXX at the end of `name` is replaced. Returns false, with errno, after an error. */
bool system_scratch_folder(char *name);

/* Locks the file until it is closed. Returns false if another program has locked it, but true after other errors. */
bool system_lock(FILE *file);

void system_set_mode(FILE *file, unsigned mode);

/* A temporary file, which vanishes when it is closed. Returns NULL, with errno, after an error. */
FILE *system_scratch(void);

/* Starts a shell command. Returns a stream of its output, or NULL, with errno, if it cannot be started. */
FILE *system_read_from(const char *command);
/* Like system_read_from(), but returns a stream to the command's input. Its output and messages go to the two files.
 * Writing to the stream fails if the command has ended. */
FILE *system_write_to(const char *command, FILE *output, FILE *messages);
/* Waits for the command's end. Returns its exit status, or -1 if it has none or `command` is NULL. */
int system_end(FILE *command);

#endif
