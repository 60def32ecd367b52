/* commands.h: the commands of `whirl`. Each takes the words after its name and returns an exit status (base/exit.h). */
#ifndef CLI_COMMANDS_H
#define CLI_COMMANDS_H

int command_list(int count, char **words);
int command_new(int count, char **words);
int command_check(int count, char **words);
int command_derive(int count, char **words);
int command_describe(int count, char **words);
int command_examine(int count, char **words);
int command_accel(int count, char **words);
int command_run(int count, char **words);
int command_plot(int count, char **words);
int command_figure(int count, char **words);
int command_sweep(int count, char **words);
int command_price(int count, char **words);
int command_choose(int count, char **words);
int command_effects(int count, char **words);
int command_trust(int count, char **words);
int command_prove(int count, char **words);
int command_map(int count, char **words);
int command_pil(int count, char **words);
int command_monitor(int count, char **words);
int command_firstlight(int count, char **words);
int command_emit_scenes(int count, char **words);
int command_hashes(int count, char **words);

#endif
