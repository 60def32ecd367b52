/* blocks.h: the number of memory blocks in use. Only with glibc can a program replace its allocator to count them. */
#ifndef TESTS_HOST_BLOCKS_H
#define TESTS_HOST_BLOCKS_H

#include <stdbool.h>

/* Number of memory blocks that are allocated and not freed. The result is always 0 with the address sanitizer, which
 * finds leaks itself, and with a C library other than glibc; then blocks_are_counted() is false. */
long blocks_in_use(void);
bool blocks_are_counted(void);

#endif
