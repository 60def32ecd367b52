/* unwritten.c: see unwritten.h. */
#include "unwritten.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

void unwritten_say(const char *name) {
    const int reason = errno;
    fprintf(stderr, "%s: error: cannot be written: %s\n", name[0] != '\0' ? name : "''",
            strerror(reason));
}
