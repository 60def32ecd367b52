/* expression.c: the grammar of expressions.
 *
 *   sum     := product { (+|-) product }
 *   product := signed { (*|/) signed }
 *   signed  := (+|-) signed | power
 *   power   := primary [ ^ signed ]            so -x^2 is -(x^2) and 2^3^2 is 2^(3^2)
 *   primary := NUMBER [UNIT] | NAME | FUNCTION ( sum {, sum} ) | ( sum )
 *
 * Recursion is bounded by NESTING_MAX. */
#include <stdio.h>
#include <string.h>

#include "expression.h"

#include "cursor.h"

static const expr *parse_sum(parser *in);
static const expr *parse_signed(parser *in);

static bool go_deeper(parser *in) {
    if (++in->nesting > NESTING_MAX) {
        return parser_fail(in, "name parts of it with let", "nested more than %d deep",
                           NESTING_MAX);
    }
    return true;
}

bool parse_unit(parser *in, unit_scale *result, const char **text) {
    unit_error error;
    const token bracket = in->token;
    const bool good = unit_parse(bracket.text, bracket.length, result, &error);
    if (!good) {
        diag_error(in->diags, place_after(bracket.at, 1 + error.offset),
                   error.hint[0] == '\0' ? NULL : error.hint, "%s", error.message);
        *result = (unit_scale){1.0, 1.0, dim_none(), enclosure_of(1.0)};
        result->dim.unknown = true;
    }
    char *bare = parser_copy_text(in, &bracket);
    size_t length = 0;
    for (const char *from = bare; *from != '\0'; from++) {
        if (strchr(" \t\r\n", *from) == NULL) {
            bare[length++] = *from;
        }
    }
    bare[length] = '\0';
    *text = bare;
    parser_next(in);
    return good;
}

static const expr *parse_number(parser *in) {
    expr *made = expr_new(in, EXPR_NUMBER, in->token.at);
    made->number = in->token.number;
    made->exact = in->token.exact;
    made->dim.any = made->number == 0.0;
    parser_next(in);
    if (in->token.kind == TOKEN_UNIT) {
        const place bracket = in->token.at;
        unit_scale written;
        parse_unit(in, &written, &in->number_unit_text);
        in->number_unit = written;
        made->number = made->number * written.scale / written.divisor;
        made->exact = enclosure_mul(made->exact, written.exact);
        made->dim = written.dim;
        made->uses = USES_UNIT;
        if (!(made->number - made->number == 0.0)) {
            diag_error(in->diags, bracket, NULL, "in SI units this number is too large");
            made->number = 0.0;
        }
    }
    return made;
}

bool parse_close(parser *in, place open) {
    if (parser_is_sign(in, ')')) {
        in->parentheses--;
        parser_next(in);
        return true;
    }
    char words[80];
    token_words(&in->token, words, sizeof words);
    if (in->token.kind == TOKEN_END || in->token.at.line != open.line) {
        if (in->token.kind != TOKEN_BAD) {
            diag_error(in->diags, open, NULL, "this parenthesis is not closed");
        }
        return false;
    }
    if (in->token.kind == TOKEN_NAME || in->token.kind == TOKEN_NUMBER) {
        char hint[OPERATOR_HINT];
        return parser_fail(in, parser_operator_hint(in, hint),
                           "')' or an operator is missing before %s", words);
    }
    if (in->token.kind == TOKEN_UNIT) {
        return parser_fail(in, "a unit belongs to a number: 2 [kg]", "a unit without a number");
    }
    return parser_fail(in, NULL, "')' is missing before %s", words);
}

static const expr *parse_call(parser *in, function_id function, place at) {
    const place open = in->token.at;
    const char *name = function_name(function);
    const int wanted = function_arguments(function);
    in->parentheses++;
    parser_next(in);
    if (!go_deeper(in)) {
        return NULL;
    }
    const expr *arguments[2] = {NULL, NULL};
    int count = 0;
    if (!parser_is_sign(in, ')')) {
        for (;;) {
            if (count == wanted) {
                parser_fail(in, NULL, "%s takes %s", name,
                            wanted == 1 ? "one argument" : "two arguments");
                return NULL;
            }
            arguments[count] = parse_sum(in);
            if (arguments[count] == NULL) {
                return NULL;
            }
            count++;
            if (!parser_is_sign(in, ',')) {
                break;
            }
            parser_next(in);
        }
    }
    if (count < wanted && parser_is_sign(in, ')')) {
        parser_fail(in, NULL, "%s takes %s", name, wanted == 1 ? "one argument" : "two arguments");
        return NULL;
    }
    if (!parse_close(in, open)) {
        return NULL;
    }
    in->nesting--;
    return expr_call(in, function, at, arguments[0], arguments[1]);
}

static const expr *parse_named(parser *in) {
    const token name = in->token;
    function_id function = FN_SIN;
    const bool is_function = function_find(name.text, name.length, &function);
    parser_next(in);
    if (is_function && name.primes == 0) {
        if (parser_is_sign(in, '(')) {
            return parse_call(in, function, name.at);
        }
        char hint[40];
        snprintf(hint, sizeof hint, parser_is_sign(in, '^') ? "write %s(x)^2" : "write %s(x)",
                 function_name(function));
        diag_error(in->diags, name.at, hint, "%s needs its argument in parentheses",
                   function_name(function));
        return NULL;
    }
    if (parser_is_sign(in, '(') && !word_is_reserved(name.text, name.length)) {
        char words[80];
        char hint[300];
        nearest search = nearest_start(name.text, name.length);
        for (int f = 0; f < FUNCTIONS; f++) {
            nearest_offer(&search, function_name((function_id)f));
        }
        const char *first = first_word_hint(name.text, name.length);
        if (first != NULL) {
            snprintf(hint, sizeof hint, "%s", first);
        } else if (search.best != NULL) {
            snprintf(hint, sizeof hint, "did you mean '%s'?", search.best);
        } else if (in->names != NULL && names_find(in->names, name.text, name.length) != NULL) {
            snprintf(hint, sizeof hint, "products are written with *; a coordinate has no (t)");
        } else {
            size_t at = (size_t)snprintf(hint, sizeof hint, "the functions are");
            for (int f = 0; f < FUNCTIONS; f++) {
                at += (size_t)snprintf(hint + at, sizeof hint - at, "%s %s", f > 0 ? "," : "",
                                       function_name((function_id)f));
            }
        }
        diag_error(in->diags, name.at, hint, "there is no function %s",
                   token_words(&name, words, sizeof words));
        return NULL;
    }
    return expr_name(in, &name);
}

static const expr *parse_primary(parser *in) {
    if (in->ready != NULL) {
        const expr *taken = in->ready;
        in->ready = NULL;
        return taken;
    }
    if (in->token.kind == TOKEN_NUMBER) {
        return parse_number(in);
    }
    if (in->token.kind == TOKEN_NAME) {
        return parse_named(in);
    }
    if (parser_is_sign(in, '(')) {
        const place open = in->token.at;
        if (!go_deeper(in)) {
            return NULL;
        }
        in->parentheses++;
        parser_next(in);
        const expr *inner = parse_sum(in);
        if (inner == NULL || !parse_close(in, open)) {
            return NULL;
        }
        in->nesting--;
        return inner;
    }
    char words[80];
    token_words(&in->token, words, sizeof words);
    if (in->token.kind == TOKEN_NEWLINE) {
        parser_fail(in, "a line goes on only while a parenthesis or brace is open",
                    "a value is missing before the end of the line");
    } else if (in->token.kind == TOKEN_UNIT) {
        parser_fail(in, "a unit belongs to a number: 2 [kg]; there are no matrices",
                    "a unit without a number");
    } else {
        parser_fail(in, NULL, "a value is missing before %s", words);
    }
    return NULL;
}

static const expr *parse_power(parser *in) {
    const expr *base = parse_primary(in);
    if (base == NULL || !parser_is_sign(in, '^')) {
        return base;
    }
    const place at = in->token.at;
    parser_next(in);
    if (!go_deeper(in)) {
        return NULL;
    }
    const expr *exponent = parse_signed(in);
    in->nesting--;
    return exponent == NULL ? NULL : expr_binary(in, EXPR_POW, at, base, exponent);
}

static const expr *parse_signed(parser *in) {
    if (in->ready != NULL || (!parser_is_sign(in, '-') && !parser_is_sign(in, '+'))) {
        return parse_power(in);
    }
    const token sign = in->token;
    if (!go_deeper(in)) {
        return NULL;
    }
    parser_next(in);
    const expr *operand = parse_signed(in);
    in->nesting--;
    if (operand == NULL || sign.sign == '+') {
        return operand;
    }
    return expr_negate(in, sign.at, operand);
}

static const expr *parse_product(parser *in) {
    const expr *left = parse_signed(in);
    while (left != NULL && (parser_is_sign(in, '*') || parser_is_sign(in, '/'))) {
        const token sign = in->token;
        parser_next(in);
        if (sign.sign == '*' && parser_is_sign(in, '*')) {
            parser_fail(in, "powers are written with ^: r^2", "'**' is no operator");
            return NULL;
        }
        const expr *right = parse_signed(in);
        left = right == NULL
                   ? NULL
                   : expr_binary(in, sign.sign == '*' ? EXPR_MUL : EXPR_DIV, sign.at, left, right);
    }
    return left;
}

static const expr *parse_sum(parser *in) {
    const expr *left = parse_product(in);
    while (left != NULL && (parser_is_sign(in, '+') || parser_is_sign(in, '-'))) {
        const token sign = in->token;
        parser_next(in);
        const expr *right = parse_product(in);
        left = right == NULL
                   ? NULL
                   : expr_binary(in, sign.sign == '+' ? EXPR_ADD : EXPR_SUB, sign.at, left, right);
    }
    return left;
}

const expr *parse_expression(parser *in, expr_context context) {
    const expr_context outer = in->context;
    in->context = context;
    in->nesting = 0;
    const expr *made = parse_sum(in);
    in->context = outer;
    return made;
}
