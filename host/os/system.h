/* system.h: services of the operating system: interrupts, time, other programs. host/os/posix has them. host/os/none
 * replaces them on a machine without such a system: no interrupt comes there, and no program can be started. */
#ifndef OS_SYSTEM_H
#define OS_SYSTEM_H

#include <signal.h>
#include <stdbool.h>
#include <stdio.h>

/* Set by the first SIGINT or SIGTERM. A second one ends the program at once, even while it waits. */
extern volatile sig_atomic_t interrupted;

/* Catch interrupts from now on. A read or write that is interrupted continues, so that no record is cut. */
void interrupts_catch(void);

/* As above, for a command that waits for another program: an interrupt, or the loss of the terminal, ends its wait. */
void interrupts_catch_waiting(void);

/* Call it at the program's start. A write beyond `ulimit -f` then fails as on a full disk. */
void system_begin(void);

/* Seconds of a clock that never goes back. */
double system_now_s(void);

/* Make a temporary folder; other characters replace the XXXXXX at the end of `name`. False, with errno, after an error. */
bool system_scratch_folder(char *name);

/* Lock the file until it is closed. Returns false if another program has locked it. True, too, on a system without
 * locks. */
bool system_lock(FILE *file);

/* Give the open file these permissions. */
void system_set_mode(FILE *file, unsigned mode);

/* A temporary file without a name, which vanishes when it is closed. NULL, with errno, after an error. */
FILE *system_scratch(void);

/* Start a shell command. The stream reads the command's output; or it writes the command's input, while output and messages go to
 * these files. NULL, with errno, if the command cannot be started. If it ends early, writes fail. */
FILE *system_read_from(const char *command);
FILE *system_write_to(const char *command, FILE *output, FILE *messages);
/* Wait for the command's end. Returns its exit status, or -1; -1, too, for NULL. */
int system_end(FILE *command);

#endif
