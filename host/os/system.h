/* system.h: services of the operating system, in host/os/posix. In host/os/none, for machines without such a system,
 * there are no interrupts, and no program can be started. */
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

/* Call this at the program's start. A write beyond `ulimit -f` then fails like on a full disk, and an interrupt ends
 * the program with a message until interrupts are caught. */
void system_begin(void);

/* Seconds of a clock that never goes back. */
double system_now_s(void);

/* Makes a temporary folder; the XXXXXX at the end of `name` is replaced. Returns false, with errno, after an error. */
bool system_scratch_folder(char *name);

/* Locks the file until it is closed. Returns false if another program has locked it; true if locks do not exist. */
bool system_lock(FILE *file);

void system_set_mode(FILE *file, unsigned mode);

/* A temporary file, which vanishes when it is closed. Returns NULL, with errno, after an error. */
FILE *system_scratch(void);

/* Start a shell command, and return a stream from its output or to its input. system_write_to(): output and messages go
 * to these files. NULL, with errno, if the command cannot be started. Writes fail if it has ended. */
FILE *system_read_from(const char *command);
FILE *system_write_to(const char *command, FILE *output, FILE *messages);
/* Waits for the command's end. Returns its exit status, or -1 if it has none or `command` is NULL. */
int system_end(FILE *command);

#endif
