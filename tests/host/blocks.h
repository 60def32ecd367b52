/* blocks.h: the number of memory blocks in use. Only with glibc can a program replace its allocator to count them. */
#ifndef TESTS_HOST_BLOCKS_H
#define TESTS_HOST_BLOCKS_H

#include <stdbool.h>

/* Memory blocks allocated and not freed. Always 0 with another C library or with the address sanitizer, which finds
 * leaks itself; then blocks_are_counted() returns false. */
long blocks_in_use(void);
bool blocks_are_counted(void);

#endif
