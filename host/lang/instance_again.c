/* instance_again.c: the numbers of an instance, evaluated once more. */
#include "host/base/arena.h"
#include "model.h"
#include "value.h"

static double value_of(const expr *given, const symbol *of, valuation *values) {
    return given != NULL ? finite_value(given, values, given->at, of->name) : 0.0;
}

static void evaluate(valuation *values, const instance *first, instance *made) {
    const mechanism *of = first->mechanism;
    for (int i = 0; i < of->parameter_count; i++) {
        values->parameter_expr[i] = first->parameter_given[i];
    }
    for (int i = 0; i < of->parameter_count; i++) {
        made->parameter[i] = parameter_value(values, i);
    }
    for (int i = 0; i < of->input_count; i++) {
        made->input[i] = value_of(first->input_given[i], of->inputs[i], values);
    }
    for (int i = 0; i < of->coordinate_count; i++) {
        for (int k = 0; k < first->start_count[i]; k++) {
            made->start[i][k] = value_of(first->start_given[i][k], of->coordinates[i], values);
        }
    }
}

instance *instance_again(const instance *first) {
    const mechanism *of = first->mechanism;
    struct arena *memory = arena_new();
    instance *made = arena_alloc(memory, sizeof *made);
    *made = *first;
    made->arena = memory;
    made->parameter = arena_alloc(memory, (size_t)of->parameter_count * sizeof *made->parameter);
    made->input = arena_alloc(memory, (size_t)of->input_count * sizeof *made->input);
    made->start = arena_alloc(memory, (size_t)of->coordinate_count * sizeof *made->start);
    for (int i = 0; i < of->coordinate_count; i++) {
        const int count = first->start_count[i] < 2 ? 2 : first->start_count[i];
        made->start[i] = arena_alloc(memory, (size_t)count * sizeof **made->start);
    }
    diags *unsaid = diags_new();
    valuation values = valuation_new(of, memory, unsaid);
    evaluate(&values, first, made);
    const bool good = diags_calls(unsaid) == 0;
    diags_free(unsaid);
    if (!good) {
        instance_free(made);
        return NULL;
    }
    return made;
}
