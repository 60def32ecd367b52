/* light_page.h: the page of first lights: a table with a row for each record. */
#ifndef COMMANDS_LIGHT_PAGE_H
#define COMMANDS_LIGHT_PAGE_H

#include "host/monitor/light.h"

#define LIGHT_PAGE "docs/silicon.md"

/* The record's row, to be freed: `equal` hashes are, the fields `differ` are not. */
char *light_row(const light *l, int equal, const char *differ);

/* Puts the row behind the last one of the page's table, unless the page has this record already; says so. Returns an exit
 * code. */
int light_append(const char *page, const char *row, uint32_t crc);

#endif
