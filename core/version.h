/* version.h: the version of Whirl: of its program, and of images that name it. */
#ifndef WH_VERSION_H
#define WH_VERSION_H

#define WH_VERSION "0.1.0"

#endif
