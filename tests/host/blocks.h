/* blocks.h: count of the memory blocks in use, where glibc lets a program replace its allocator. */
#ifndef TESTS_HOST_BLOCKS_H
#define TESTS_HOST_BLOCKS_H

#include <stdbool.h>

/* Always 0 with other C libraries; the sanitizers find leaks there. */
long blocks_in_use(void);
bool blocks_are_counted(void);

#endif
