/* flash.h: constant tables that stay in flash.
 *
 * An AVR reads its flash by a special instruction; a plain `const` object would be copied to its scarce RAM. avr-gcc's
 * __flash exists neither in strict C11 nor in C++, so this file has the attribute and the instruction itself. On other
 * processors, and on the smallest AVRs (__AVR_TINY__), constants are ordinary.
 *
 *      const wh_real table[2] WH_FLASH = {WH_R(1.0), WH_R(0.5)};
 *      wh_real half = wh_flash_real(&table[1]);
 *
 * If WH_WORDS_FROM is defined (with a linker script that supports it: boards/atmega), constant strings stay in flash.
 * Their addresses are at least WH_WORDS_FROM; RAM's are lower. wh_word_at() reads one character of a string. */
#ifndef WH_FLASH_H
#define WH_FLASH_H

#include "../real.h"

#if !defined(__AVR__) || defined(__AVR_TINY__) || WH_DOUBLE

#define WH_FLASH
/* Reads a number of a WH_FLASH table. On an AVR the table must be in the lowest 64 kB, where linkers put such tables. */
WH_INLINE wh_real wh_flash_real(const wh_real *from) { return *from; }

#elif defined(__clang__)

#define WH_FLASH __attribute__((__section__(".progmem.data")))
WH_INLINE wh_real wh_flash_real(const wh_real *from) {
    return *(const __attribute__((__address_space__(1))) wh_real *)(uintptr_t)from;
}

#else

#define WH_FLASH __attribute__((__progmem__))
WH_INLINE wh_real wh_flash_real(const wh_real *from) {
    wh_real value;
#if defined(__AVR_HAVE_LPMX__)
    __asm__("lpm %A0, Z+\n\tlpm %B0, Z+\n\tlpm %C0, Z+\n\tlpm %D0, Z" : "=&r"(value), "+z"(from));
#else
    __asm__("lpm\n\tmov %A0, r0\n\tadiw r30, 1\n\tlpm\n\tmov %B0, r0\n\tadiw r30, 1\n\t"
            "lpm\n\tmov %C0, r0\n\tadiw r30, 1\n\tlpm\n\tmov %D0, r0"
            : "=&r"(value), "+z"(from)
            :
            : "r0");
#endif
    return value;
}

#endif

WH_INLINE void wh_flash_copy(void *to, const void *from, unsigned count) {
#if defined(__AVR_HAVE_LPMX__) && !WH_DOUBLE
    uint8_t *bytes = (uint8_t *)to;
    const uint8_t *at = (const uint8_t *)from;
    for (unsigned i = 0; i < count; i++) {
        __asm__("lpm %0, Z" : "=r"(bytes[i]) : "z"(&at[i]));
    }
#else
    __builtin_memcpy(to, from, count);
#endif
}

/* Attribute of a constant list of strings. */
#if defined(WH_WORDS_FROM)
#define WH_WORD_LIST __attribute__((__section__(".rodata.str.lists")))
#else
#define WH_WORD_LIST
#endif

WH_INLINE char wh_word_at(const char *at) {
#if defined(__AVR_HAVE_LPMX__) && defined(WH_WORDS_FROM)
    if ((uintptr_t)at >= WH_WORDS_FROM) {
        char character;
        __asm__("lpm %0, Z" : "=r"(character) : "z"(at));
        return character;
    }
#endif
    return *at;
}

#endif
