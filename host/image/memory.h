/* memory.h: the memory that a scene takes, by number, in bytes of this machine: what WH_MEMORY_BYTES() comes to where
 * pointers play no part, as on every board with eight-byte alignment of its 64-bit integers. */
#ifndef IMAGE_MEMORY_H
#define IMAGE_MEMORY_H

#include "image.h"

size_t memory_float_bytes(const image *im);
size_t memory_double_bytes(const image *im);

#endif
