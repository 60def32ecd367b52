/* unwritten.h: a file that takes nothing, or no more. */
#ifndef BASE_UNWRITTEN_H
#define BASE_UNWRITTEN_H

/* On standard error: the file cannot be written, and why, as errno has it. */
void unwritten_say(const char *name);

#endif
