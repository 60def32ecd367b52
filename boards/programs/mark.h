/* mark.h: marks for the counting plugin, which cost no instruction.
 *
 * WH_MARK(kind) writes the address of the instruction that follows it, and `kind` (1 to 3), into the section
 * .wh_marks of the object file, once for each place the compiler puts it, inlined ones included. The linker is
 * told to keep the section (R), which nothing refers to. */
#ifndef WH_MARK_H
#define WH_MARK_H

#define WH_MARK(kind) \
    __asm__ inline volatile("0: .pushsection .wh_marks,\"R\",%%progbits\n" \
                            ".word 0b, %c0\n" \
                            ".popsection" \
                            : \
                            : "i"(kind))

#endif
