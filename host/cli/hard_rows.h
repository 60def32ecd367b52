/* hard_rows.h: the catalogue of hard cases: X(case, scene, limit of the theory, verdict). A case is a section of
 * docs/hard_cases.md; a scene is a file of docs/hard, a built-in scene, or "". */
#ifndef CLI_HARD_ROWS_H
#define CLI_HARD_ROWS_H

#define HARD_ROWS(X) \
    X("Chaos", "thomson_a", "a further digit buys the time in which one digit grows", \
      "told: the time until which a run is trusted") \
    X("The pole and the origin", "polar", "no fixed step resolves every distance", \
      "right, or told with a step that resolves it") \
    X("Mass matrices that are nearly singular", "disc masses soft_spring", \
      "no digit is left at a ratio of 1e16, in float of 1e7", "right, or told, or refused") \
    X("Dead centres", "dead_centre", "rigid bodies do not share a redundant load", "right") \
    X("Springs too stiff for the step", "stiff_spring", "Runge-Kutta 4 grows above h w = 2.83", \
      "told before 1 % of the energy is lost") \
    X("A hard floor", "stiff_stop", "above h w = 1 the energy after a bounce is chance", \
      "told; right with a stop") \
    X("Resonance without damping", "resonance", "the phase error is (h w)^4/120 of w t", \
      "right: order 4") \
    X("A motor too weak for a resonance", "sommerfeld", "none but that of the method", "right") \
    X("Friction under a load that vanishes", "pulsating_load", \
      "a step across a kink is of second order", "right: order 4, kinks are events") \
    X("Bounces that end", "moving_floor", "infinitely many impacts in a finite time", "right") \
    X("Contacts that repeat each other", "redundant", "only the moment of release is determined", \
      "right") \
    X("Newton's cradle", "cradle", "rigid bodies do not give the order of the waves", "right") \
    X("Rotation", "rotor", "the direction is lost at half a turn a step", \
      "right, or told, or refused") \
    X("Very long runs", "long", "no explicit step keeps the energy", "right with --stabilized") \
    X("Very large and very small numbers", "scales", "float keeps nothing below 1.4e-45", \
      "right, or told, or refused") \
    X("Inputs that jump", "jump", "an input stands still within a step", \
      "right between steps and in a `when`") \
    X("Poles that a step jumps over", "used_up", "no error estimate sees between the stages", \
      "told, and not trusted")

#endif
