/* memory.h: the memory of a scene for each number type, in bytes of this machine: WH_MEMORY_BYTES(). It equals that of
 * any board with eight-byte alignment of 64-bit integers if pointers do not matter. */
#ifndef IMAGE_MEMORY_H
#define IMAGE_MEMORY_H

#include "image.h"

size_t memory_float_bytes(const image *im);
size_t memory_double_bytes(const image *im);

#endif
