/* brief.h: what the console says to people beside what programs read: left out where flash is scarce
 * (-DWH_STATION_BRIEF=1). Names, numbers and values stay; docs/console.md has the words. */
#ifndef WH_STATION_BRIEF_H
#define WH_STATION_BRIEF_H

#include "core/packed_words.h"

#ifndef WH_STATION_BRIEF
#define WH_STATION_BRIEF 0
#endif

#if WH_STATION_BRIEF
#define WH_SAY(words) ""
#else
#define WH_SAY(words) WH_WORDS(words)
#endif

#endif
