/* scenes.c: runs every generated scene to its end and prints the hash of the scene's last state:
 *
 *     scene NAME steps N hash 0x0123456789abcdef ok
 *
 * The PC and every board must print the same lines. If a scene diverges, its line has the hash of the last good state,
 * and ends with the error instead of ok; the other scenes still run. Without scenes the program fails. */
#include "boards/programs/to_the_end.h"

int main(void) { board_exit(run_all_to_the_end()); }
