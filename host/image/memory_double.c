/* memory_double.c: memory in double, the reference's number type. */
#define WH_DOUBLE 1
#include "core_rows.h"
#include "host/image/image.h"

size_t memory_double_bytes(const image *im) {
    return WH_MEMORY_BYTES(im->angles, core_memory_reals(im), im->contacts);
}
