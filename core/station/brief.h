/* brief.h: what the console does without where flash is scarce: what it says to people beside what programs read
 * (-DWH_STATION_BRIEF=1), of which names, numbers and values stay and docs/console.md has the words; and recording control
 * steps (-DWH_STATION_TAPE=0; tape_out.h). */
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

#ifndef WH_STATION_TAPE
#define WH_STATION_TAPE 1
#endif

/* Of rows, those of tapes. */
#if WH_STATION_TAPE
#define WH_OF_TAPES(rows) rows
#else
#define WH_OF_TAPES(rows)
#endif

#endif
