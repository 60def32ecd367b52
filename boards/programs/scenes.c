/* scenes.c: runs every generated scene to its end and prints the hash of its last state:
 *
 *     scene NAME steps N hash 0x0123456789abcdef ok
 *
 * The same lines must come out on the PC and on every board. A scene that diverges says so in the
 * last words, with the hash of its last good state; the others still run. Fails if none is there. */
#include "boards/programs/to_the_end.h"

int main(void) { board_exit(run_all_to_the_end()); }
