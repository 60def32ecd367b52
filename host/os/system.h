/* system.h: services of the operating system: interrupts, time, other programs. host/os/posix has them. host/os/none
 * replaces them on a machine without such a system: no interrupt comes there, and no program can be started. */
#ifndef OS_SYSTEM_H
#define OS_SYSTEM_H

#include <signal.h>
#include <stdbool.h>
#include <stdio.h>

/* Set by the first SIGINT or SIGTERM; a second ends the program at once, whatever it waits for. */
extern volatile sig_atomic_t interrupted;

/* From here on. What is read and written goes on over it: no record is cut. */
void interrupts_catch(void);

/* The same of what waits for another program, which an interrupt is to wake; and when the terminal goes away. */
void interrupts_catch_waiting(void);

/* At the program's start: a write beyond `ulimit -f` then fails as on a full disk. */
void system_begin(void);

/* Seconds of a clock that never goes back. */
double system_now_s(void);

/* Make a folder: the XXXXXX at the end of its name become others. False, with errno, if there can be none. */
bool system_scratch_folder(char *name);

/* False if another program has this file to itself; where there are no locks, true. The lock ends with the file. */
bool system_lock(FILE *file);

/* Give the open file these permissions. */
void system_set_mode(FILE *file, unsigned mode);

/* A file without a name, gone when closed. NULL, with errno, if there can be none. */
FILE *system_scratch(void);

/* Start a shell's command, and read its output; or write its input, with its output and messages in these files. NULL,
 * with errno, if it cannot be started. A command that ends early makes writes fail. */
FILE *system_read_from(const char *command);
FILE *system_write_to(const char *command, FILE *output, FILE *messages);
/* Wait for its end. Returns its exit status, or -1, as for NULL. */
int system_end(FILE *command);

#endif
