/* version.h: the version of Whirl: of its program, and of images that name it. */
#ifndef WH_VERSION_H
#define WH_VERSION_H

#define WH_VERSION "0.1.0"

#define WH_VERSION_NUMBER 100 /* 10000 major + 100 minor + patch: generated headers ask for it */

enum { WH_VERSION_MAJOR = 0, WH_VERSION_MINOR = 1, WH_VERSION_PATCH = 0 };

#endif
