/* condition.c: the condition of `hold ... while`.
 *
 *   condition  := both { or both }
 *   both       := comparison { and comparison }
 *   comparison := sum (> | >= | < | <=) sum | ( condition )
 *
 * It becomes one expression, true when above zero: a > b is a - b, `and` is min, `or` is max. What a
 * parenthesis holds, a condition or the beginning of a sum, shows only behind it: both are read by the
 * same functions, and a sum goes on from there. Recursion is bounded by NESTING_MAX. */
#include <string.h>

#include "cursor.h"
#include "expression.h"

typedef struct reading {
    word_id statement; /* for hints */
    int depth;         /* of parentheses */
} reading;

static const expr *parse_any(parser *in, reading *how, bool *is_condition);

static bool at_comparison(const parser *in) {
    return parser_is_sign(in, '>') || parser_is_sign(in, '<') ||
           parser_is_sign(in, SIGN_AT_LEAST) || parser_is_sign(in, SIGN_AT_MOST);
}

static const expr *missing_comparison(parser *in, const reading *how) {
    char words[80];
    const bool equal = parser_is_sign(in, SIGN_EQUAL) || parser_is_sign(in, '=');
    parser_fail(in,
                equal ? "two numbers are hardly ever equal: compare with >, <, >= or <="
                      : word_row(how->statement)->form,
                "a comparison is missing before %s", token_words(&in->token, words, sizeof words));
    return NULL;
}

/* A condition in parentheses, or the sum that begins with them. */
static const expr *parse_group(parser *in, reading *how, bool *is_condition) {
    const place open = in->token.at;
    if (how->depth == NESTING_MAX) {
        parser_fail(in, "name parts of it with let", "nested more than %d deep", NESTING_MAX);
        return NULL;
    }
    how->depth++;
    in->parentheses++;
    parser_next(in);
    const expr *inner = parse_any(in, how, is_condition);
    how->depth--;
    if (inner == NULL || !parse_close(in, open)) {
        return NULL;
    }
    if (*is_condition) {
        return inner;
    }
    in->ready = inner;
    return parse_expression(in, CONTEXT_EVENT);
}

static const expr *parse_comparison(parser *in, reading *how, bool *is_condition) {
    *is_condition = false;
    const expr *left = parser_is_sign(in, '(') ? parse_group(in, how, is_condition)
                                               : parse_expression(in, CONTEXT_EVENT);
    if (left == NULL || *is_condition || !at_comparison(in)) {
        return left;
    }
    const token sign = in->token;
    const bool above = sign.sign == '>' || sign.sign == SIGN_AT_LEAST;
    parser_next(in);
    const expr *right = parse_expression(in, CONTEXT_EVENT);
    if (right == NULL) {
        return NULL;
    }
    if (at_comparison(in)) {
        parser_fail(in, "join two comparisons with and: x > a and x < b",
                    "one comparison at a time");
        return NULL;
    }
    const expr *by = expr_difference(in, sign.at, above ? left : right, above ? right : left);
    if (by == NULL) {
        return NULL;
    }
    /* Of comparisons only the signs matter: lengths and speeds may be joined. */
    expr *made = expr_new(in, by->op, by->at);
    *made = *by;
    made->dim = dim_none();
    *is_condition = true;
    return made;
}

/* PART { word PART }, the parts conditions unless there is but one. */
static const expr *parse_joined(parser *in, reading *how, word_id word, function_id function,
                                const expr *(*part)(parser *, reading *, bool *),
                                bool *is_condition) {
    const expr *left = part(in, how, is_condition);
    while (left != NULL && parser_is_word(in, word)) {
        const place at = in->token.at;
        if (!*is_condition) {
            return missing_comparison(in, how);
        }
        parser_next(in);
        const expr *right = part(in, how, is_condition);
        if (right == NULL) {
            return NULL;
        }
        if (!*is_condition) {
            return missing_comparison(in, how);
        }
        left = expr_call(in, function, at, left, right);
    }
    return left;
}

static const expr *parse_both(parser *in, reading *how, bool *is_condition) {
    return parse_joined(in, how, WORD_AND, FN_MIN, parse_comparison, is_condition);
}

static const expr *parse_any(parser *in, reading *how, bool *is_condition) {
    return parse_joined(in, how, WORD_OR, FN_MAX, parse_both, is_condition);
}

const expr *parse_condition(parser *in, word_id statement) {
    reading how = {statement, 0};
    bool is_condition = false;
    const expr *made = parse_any(in, &how, &is_condition);
    return made == NULL || is_condition ? made : missing_comparison(in, &how);
}
