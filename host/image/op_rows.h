/* op_rows.h: the table of operations. All lists of operations are made of these rows, or switch over op_code with
 * -Wswitch-enum.
 *
 * X(id, kind, cost, C, Octave, meaning)
 *
 *   id      OP_id of op_list.h. Model hashes depend on the order: add a new one at the end.
 *   kind    OP_IS_... of op_list.h: the meaning of a and b.
 *   cost    OP_COSTS_... of op_list.h.
 *   C, Octave  its right-hand side in generated code; NULL: not written. A dollar sign marks these:
 *           a, b   the operands.
 *           f      the called function.
 *           o      its operands, separated by commas.
 *           n      a test for b being NaN: " || b != b", or nothing if b is a constant.
 *           i      the number in a.
 *           v      the value, a whole number.
 *           l, r, u   in Octave: the linear component, rate, input with the number a.
 *
 * Four more files evaluate each operation: host/engine/evaluate.inc, host/engine/rounding.c, host/derive/solve.c,
 * host/image/op_list_gauge.c, which also multiplies it. */
#ifndef IMAGE_OP_ROWS_H
#define IMAGE_OP_ROWS_H

/* clang-format off */
#define OP_ROWS(X) \
    X(CONSTANT, CONSTANT, NOTHING, NULL, NULL, "value: stands in place") \
    X(LINEAR, LEAF, NOTHING, "linear[$i]", "y($l)", \
      "real component a: a linear position (second order), any real (first order)") \
    X(RATE, LEAF, NOTHING, "rate[$i]", "y($r)", "rate of coordinate a (second order only)") \
    X(INPUT, LEAF, NOTHING, "input[$i]", "u_$u", "input a") \
    X(ACCEL, LEAF, NOTHING, "accel[$i]", NULL, \
      "acceleration of coordinate a, contact forces in it: for records") \
    X(TIME, LEAF, NOTHING, "wh_scene_time_s(scene, state)", NULL, \
      "time, s: for records, never in a step") \
    X(RADIANS, LEAF, NOTHING, "wh_angle_to_rad(angle[$i])", NULL, \
      "unwrapped angle a in radians: for records, never in a step") \
    X(NOISE, LEAF, NOTHING, "wh_noise($vU, state->steps)", NULL, \
      "Gaussian deviate with seed `value` at this step: for records, never in a step") \
    X(PHASE, PHASE, WAVE, NULL, NULL, \
      "sum turns[i]*phase[i] + sum parts[i]*angle[i] + value [rad] + (radians from b, if b >= 0)") \
    X(SIN, WAVE, NOTHING, "s$i", "sin($a)", "sine of phase a") \
    X(COS, WAVE, NOTHING, "c$i", "cos($a)", "cosine of phase a") \
    X(ADD, BINARY, ARITHMETIC, "$a + $b", "$a + $b", "") \
    X(SUB, BINARY, ARITHMETIC, "$a - $b", "$a - $b", "") \
    X(MUL, BINARY, ARITHMETIC, "$a * $b", "$a * $b", "") \
    X(DIV, BINARY, DIVISION, "$a / $b", "$a / $b", "") \
    X(NEG, UNARY, ARITHMETIC, "-$a", "-$a", "") \
    X(SQRT, UNARY, ROOT, "WH_SQRT($a)", "sqrt($a)", "") \
    X(ABS, UNARY, ARITHMETIC, "WH_ABS($a)", "abs($a)", "") \
    X(SIGN, UNARY, ARITHMETIC, \
      "$a == $a ? (wh_real)(($a > WH_R(0.0)) - ($a < WH_R(0.0))) : $a", "sign($a)", \
      "this, MIN and MAX give NaN of NaN: nothing that is no number may vanish in a comparison") \
    X(MIN, BINARY, ARITHMETIC, "$b < $a$n ? $b : $a", "min($a, $b)", "b < a || b != b ? b : a") \
    X(MAX, BINARY, ARITHMETIC, "$b > $a$n ? $b : $a", "max($a, $b)", "b > a || b != b ? b : a") \
    X(CALL, CALL, CALL, "wh_$f($o)", "$f($o)", "function(a) or function(a, b), of core/function.h") \
    X(POW, BINARY, CALL, "wh_pow($a, $b)", "$a ^ $b", "a to the b, likewise") \
    X(CELL, CELL, NOTHING, NULL, NULL, "the cell of the list's tables that phase sum turns[i]*phase[i] is in") \
    X(LINE, LOOKUP, LINE, "wh_table_linear(&row$i[$v], y$i)", NULL, \
      "in cell a, the table whose numbers begin at `value`: linear, core/step/table.h") \
    X(CUBIC, LOOKUP, CUBIC, "wh_table_cubic(&row$i[$v], y$i)", NULL, "likewise, cubic")
/* clang-format on */

#endif
