/* blocks.h: blocks of memory in use, counted where glibc lets a program stand in front of its allocator. */
#ifndef TESTS_HOST_BLOCKS_H
#define TESTS_HOST_BLOCKS_H

#include <stdbool.h>

/* Always 0 where the C library does not tell: the sanitizers do there. */
long blocks_in_use(void);
bool blocks_are_counted(void);

#endif
