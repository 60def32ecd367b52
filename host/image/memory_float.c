/* memory_float.c: memory in float, the boards' number type. */
#include "core_rows.h"
#include "host/image/image.h"

size_t memory_float_bytes(const image *im) {
    return WH_MEMORY_BYTES(im->angles, core_memory_reals(im), im->contacts);
}
