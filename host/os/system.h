/* system.h: services of the operating system: interrupts, time, other programs. host/os/posix has them. host/os/none
 * replaces them on a machine without such a system: no interrupt comes there, and no program can be started. */
#ifndef OS_SYSTEM_H
#define OS_SYSTEM_H

#include <signal.h>
#include <stdbool.h>
#include <stdio.h>

/* Set by the first SIGINT or SIGTERM. A second one ends the program at once, also while it waits. */
extern volatile sig_atomic_t interrupted;

/* Catches interrupts from now on. A read or write that is interrupted continues, so that no record is cut. */
void interrupts_catch(void);

/* As interrupts_catch(), for a command that waits for another program: an interrupt, or the loss of the terminal, ends
 * the wait. */
void interrupts_catch_waiting(void);

/* Must be called at the program's start. A write beyond `ulimit -f` then fails as on a full disk. Until interrupts are
 * caught, an interrupt ends the program with a message. */
void system_begin(void);

/* Returns the seconds of a clock that never goes back. */
double system_now_s(void);

/* Makes a temporary folder. Other characters replace the XXXXXX at the end of `name`. Returns false, with errno, after
 * an error. */
bool system_scratch_folder(char *name);

/* Locks the file until it is closed. Returns false if another program has locked it; true also on a system without
 * locks. */
bool system_lock(FILE *file);

/* Gives the open file these permissions. */
void system_set_mode(FILE *file, unsigned mode);

/* Returns a temporary file without a name, which vanishes when it is closed. NULL, with errno, after an error. */
FILE *system_scratch(void);

/* Start a shell command. system_read_from() returns a stream with the command's output. system_write_to() returns a
 * stream to the command's input; its output and messages go to these files. NULL, with errno, if the command cannot be
 * started. If the command ends early, writes fail. */
FILE *system_read_from(const char *command);
FILE *system_write_to(const char *command, FILE *output, FILE *messages);
/* Waits for the command's end. Returns its exit status, or -1 if there is none or `command` is NULL. */
int system_end(FILE *command);

#endif
