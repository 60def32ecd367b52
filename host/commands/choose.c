#include "commands.h"
#include "host/base/exit.h"
int command_choose(int count, char **words) { (void)count; (void)words; return EXIT_BAD_INPUT; }
