/* version.h: the version of Whirl, and a link-time check that a scene's header and .c file belong together. */
#ifndef WH_VERSION_H
#define WH_VERSION_H

#define WH_VERSION "0.3.0"

#define WH_VERSION_NUMBER 300 /* 10000 major + 100 minor + patch; generated headers check it */

enum { WH_VERSION_MAJOR = 0, WH_VERSION_MINOR = 3, WH_VERSION_PATCH = 0 };

/* A generated header declares its scene under a symbol (WH_LINKS_TO) that contains the header's hash. The scene's .c
 * file defines this symbol (WH_LINKED_AS). If the two files do not match, the linker reports an undefined symbol. */
#if defined(__GNUC__) && defined(__ELF__)
#define WH_STRING_OF(text) #text
#define WH_STRING(text) WH_STRING_OF(text)
#define WH_LINKS_TO(symbol) __asm__(WH_STRING(__USER_LABEL_PREFIX__) #symbol)
#define WH_LINKED_AS(scene, symbol) \
    extern const __typeof__(scene) symbol __attribute__((weak, alias(WH_STRING(scene))))
#else
#define WH_LINKS_TO(symbol)
#define WH_LINKED_AS(scene, symbol) extern const int wh_linked_by_name
#endif

#endif
