/* map_text.h: a stability map for people and for programs. */
#ifndef MAP_MAP_TEXT_H
#define MAP_MAP_TEXT_H

#include <stdio.h>

#include "stability_map.h"

/* A row for each row, a mark for each value along it, rising. `words` tell what was run. */
void map_print(FILE *out, const stability_map *m, const char *words);
/* A row for each pair that was tried: both values, verdict, times, what is missing of the energy. */
void map_csv(FILE *out, const stability_map *m);
/* The same as one JSON object (docs/warnings.md has the schema). `status`: exit status. */
void map_json(FILE *out, const stability_map *m, const image *of, const map_wish *w, int status);

#endif
