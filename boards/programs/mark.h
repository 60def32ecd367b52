/* mark.h: marks for the counting plugin, which cost no instruction. WH_MARK(kind) writes the next instruction's address
 * and `kind` (1 to 3) into section .wh_marks; each inlined or copied instance has an entry. The flag R makes the linker
 * keep the section, although nothing refers to it. */
#ifndef WH_MARK_H
#define WH_MARK_H

#define WH_MARK(kind) \
    __asm__ inline volatile("0: .pushsection .wh_marks,\"R\",%%progbits\n" \
                            ".word 0b, %c0\n" \
                            ".popsection" \
                            : \
                            : "i"(kind))

#endif
