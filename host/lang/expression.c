/* expression.c: the grammar of expressions.
 *
 *   sum     := product { (+|-) product }
 *   product := signed { (*|/) signed }
 *   signed  := (+|-) signed | power
 *   power   := primary [ ^ signed ]            so -x^2 is -(x^2) and 2^3^2 is 2^(3^2)
 *   primary := NUMBER [UNIT] | NAME | FUNCTION ( sum {, sum} ) | ( sum )
 *
 * Recursion is bounded by NESTING_MAX. */
#include "host/lang/expression.h"

#include <string.h>

#include "host/lang/parser.h"

static const char *skip_blanks(const char *text) { return text + strspn(text, " \t"); }

const char *hint_declared_later(parser *in, const token *name) {
    const source *from = name->at.source;
    const char *text = from->text + name->at.offset;
    const char *const end = from->text + from->length;
    int line = name->at.line;
    while ((text = memchr(text, '\n', (size_t)(end - text))) != NULL) {
        line++;
        text = skip_blanks(text + 1);
        size_t length = 0;
        while (continues_name(text[length])) {
            length++;
        }
        const int word = word_find(text, length);
        if (word == WORD_MECHANISM) {
            return NULL;
        }
        if (word != WORD_COUNT && (word_row((word_id)word)->rules & DECLARES) != 0) {
            const char *declared = skip_blanks(text + length);
            if (strncmp(declared, name->text, name->length) == 0 &&
                !continues_name(declared[name->length])) {
                return arena_words(in->arena, "move the declaration in line %d above this line",
                                   line);
            }
        }
    }
    return NULL;
}

/* Returns a hint such as "write x'" for "xdot", if x is a coordinate, state or let; else NULL. */
static const char *rate_hint(parser *in, const token *name) {
    static const char *const forms[][3] = {
        {"", "dot", "'"}, {"", "_dot", "'"}, {"", "ddot", "''"}, {"", "_ddot", "''"},
        {"d", "", "'"},   {"dd", "", "''"},  {"d", "dt", "'"},   {"d", "_dt", "'"}};
    for (size_t i = 0; i < sizeof forms / sizeof forms[0]; i++) {
        const size_t before = strlen(forms[i][0]);
        const size_t behind = strlen(forms[i][1]);
        if (name->length > before + behind && strncmp(name->text, forms[i][0], before) == 0 &&
            strncmp(name->text + name->length - behind, forms[i][1], behind) == 0) {
            const size_t length = name->length - before - behind;
            const named *found = names_find(in->names, name->text + before, length);
            if (found != NULL && !found->is_placeholder &&
                (symbol_moves(&found->symbol) || found->symbol.kind == SYM_LET)) {
                return arena_words(in->arena, "write %s%s", found->symbol.name, forms[i][2]);
            }
        }
    }
    return NULL;
}

static void report_unknown(parser *in, const token *name) {
    const char *hint = first_word_hint(name->text, name->length);
    const char *later =
        in->builder != NULL && !in->all_effects ? hint_declared_later(in, name) : NULL;
    if (later != NULL) {
        hint = later;
    } else if (hint == NULL && (hint = rate_hint(in, name)) == NULL) {
        nearest search = nearest_start(name->text, name->length);
        names_offer(in->names, in->all_effects ? -2 : in->effect, &search);
        for (int f = 0; f < FUNCTIONS; f++) {
            if (parser_is_sign(in, '(')) {
                nearest_offer(&search, function_name((function_id)f));
            }
        }
        hint = parser_nearest(in, &search, NULL);
    }
    token plain = *name;
    plain.primes = 0;
    diag_error(in->diags, name->at, hint, "unknown name %s", token_words(in, &plain));
}

static void report_reserved(parser *in, const token *name) {
    static const word_id quantities[] = {WORD_T, WORD_V, WORD_F, WORD_Q};
    for (size_t i = 0; i < sizeof quantities / sizeof quantities[0]; i++) {
        if (word_is(quantities[i], name->text, name->length)) {
            const statement_word *word = word_row(quantities[i]);
            diag_error(in->diags, name->at, "name the formula with let, and use that name here",
                       "%s is %s and cannot be used in an expression", word->text,
                       term_meaning((term_kind)word->kind));
            return;
        }
    }
    diag_error(in->diags, name->at, first_word_hint(name->text, name->length),
               "'%.*s' is a reserved word", (int)name->length, name->text);
}

/* Is `found`, with the primes of `name`, allowed in the current context? `written` is the name in messages. */
static bool allowed_here(parser *in, const token *name, const symbol *found, const token *written) {
    const bool is_unknown = symbol_moves(found);
    const bool by_let = found->kind == SYM_LET && found->value != NULL;
    const int order = is_unknown ? name->primes : by_let ? found->value->order : 0;
    const unsigned uses = by_let ? found->value->uses : 0;
    const char *words = token_words(in, written);
    if (found->effect >= 0 && found->effect != in->effect && !in->all_effects) {
        diag_error(in->diags, name->at, "declare it in the mechanism to use it elsewhere",
                   "%s belongs to the effect '%s'", words,
                   in->builder->made->effects[found->effect].name);
        return false;
    }
    if (name->primes > 0 && !is_unknown) {
        diag_error(in->diags, name->at, "only coordinates, states and lets take primes",
                   "'%s' is %s: it has no derivative", found->name, symbol_kind_words(found->kind));
        return false;
    }
    if (found->kind == SYM_OUTPUT && in->context != CONTEXT_OUTPUT) {
        diag_error(in->diags, name->at, "name the output's expression with let",
                   "%s is an output: only later outputs can use it", words);
        return false;
    }
    switch (in->context) {
    case CONTEXT_CONSTANT:
        if (found->kind == SYM_INPUT || (uses & USES_INPUT) != 0) {
            diag_error(in->diags, name->at, NULL,
                       "%s changes during a run: only numbers and parameters can stand here",
                       words);
            return false;
        }
        if (is_unknown || (uses & USES_UNKNOWNS) != 0) {
            diag_error(in->diags, name->at, NULL,
                       "%s depends on the motion: only numbers and parameters can stand here",
                       words);
            return false;
        }
        break;
    case CONTEXT_FORCE:
    case CONTEXT_EVENT:
        if (order > 1) {
            diag_error(
                in->diags, name->at,
                "write it with coordinates and rates: whirl derive prints the expression of each second derivative",
                "%s cannot contain a second derivative: %s %s one",
                in->context == CONTEXT_FORCE ? "T, V, F and Q" : "stop, friction, hold and when",
                words, by_let ? "has" : "is");
            return false;
        }
        break;
    case CONTEXT_GAP:
        if (order > 0) {
            diag_error(in->diags, name->at,
                       "write the position that is to be limited or held, not its rate",
                       "'stop' and 'hold' act on coordinates, not on rates: %s %s a rate", words,
                       by_let ? "has" : "is");
            return false;
        }
        break;
    case CONTEXT_LET:
    case CONTEXT_OUTPUT:
        if (order > 2 && (found->kind == SYM_COORDINATE ||
                          (by_let && in->builder != NULL && !in->builder->has_equations))) {
            diag_error(in->diags, name->at, NULL, "a coordinate has at most two primes here");
            return false;
        }
        break;
    case CONTEXT_EQUATION: break;
    }
    return true;
}

static const expr *unknown_value(expr *made) {
    made->dim.unknown = true;
    return made;
}

static const expr *take_properties(parser *in, expr *made, const token *name) {
    const symbol *found = made->symbol;
    switch (found->kind) {
    case SYM_COORDINATE:
    case SYM_STATE:
        made->uses = USES_UNKNOWNS;
        made->order = name->primes;
        break;
    case SYM_PARAMETER:
    case SYM_INPUT:
        made->uses = found->kind == SYM_PARAMETER ? USES_PARAMETER : USES_INPUT;
        made->uses |= found->value == NULL ? USES_UNIT : found->value->uses & USES_UNIT;
        break;
    case SYM_LET:
    case SYM_OUTPUT:
    case SYM_RECORD:
        made->uses = found->kind == SYM_OUTPUT ? USES_OUTPUT : 0;
        if (found->value != NULL) {
            /* a let counts as a value with a unit, even if its expression has no unit */
            made->uses |= found->value->uses | (found->kind == SYM_LET ? USES_UNIT : 0);
            made->order = found->value->order;
            made->height = found->value->height + 1;
        }
        if (made->height > EXPR_HEIGHT_MAX) {
            diag_error(in->diags, name->at, NULL,
                       "'%s' is more than %d operators deep once its lets are inserted",
                       found->name, EXPR_HEIGHT_MAX);
            return NULL;
        }
        break;
    }
    return made;
}

static const expr *expr_name(parser *in, const token *name) {
    expr *made = expr_new(in, EXPR_SYMBOL, name->at);
    if (token_is_word(name, WORD_PI)) {
        made->op = EXPR_NUMBER;
        made->number = PI;
        made->exact = enclosure_pi();
        return made;
    }
    if (word_is_reserved(name->text, name->length)) {
        report_reserved(in, name);
        return unknown_value(made);
    }
    named *found = names_find(in->names, name->text, name->length);
    if (found == NULL) {
        if (in->names == NULL) {
            diag_error(in->diags, name->at, NULL, "only numbers can stand here");
            return unknown_value(made);
        }
        report_unknown(in, name);
        if (in->builder != NULL && !in->all_effects) {
            names_add_placeholder(in->names, name);
        }
        return unknown_value(made);
    }
    if (found->is_placeholder) {
        if (found->symbol.kind == SYM_INPUT) { /* named by an input's `rate`, but not declared */
            report_unknown(in, name);
            found->symbol.kind = SYM_LET;
        }
        return unknown_value(made);
    }
    if (found->is_open) {
        diag_error(in->diags, name->at, NULL, "'%s' is used in its own declaration",
                   found->symbol.name);
        return unknown_value(made);
    }
    token plain = *name;
    made->symbol = &found->symbol;
    while (made->symbol->kind == SYM_LET && plain.primes > 0) {
        if (made->symbol->value == NULL || made->symbol->dim.unknown) {
            return unknown_value(made); /* the error was already reported */
        }
        made->symbol = let_rate(in, made->symbol, name);
        if (made->symbol == NULL) {
            return unknown_value(made);
        }
        plain.primes--;
    }
    if (!allowed_here(in, &plain, made->symbol, name)) {
        return unknown_value(made);
    }
    made->primes = plain.primes;
    made->dim = made->symbol->dim;
    if (plain.primes > 0 && !made->dim.unknown &&
        !dim_derivative(made->dim, plain.primes, &made->dim)) {
        diag_error(in->diags, name->at, NULL, "an exponent of this dimension is outside -99 to 99");
        made->dim.unknown = true;
    }
    return take_properties(in, made, &plain);
}

void no_such_coordinate(parser *in, const token *name) {
    nearest search = nearest_start(name->text, name->length);
    const mechanism *inside = in->builder->made;
    for (int i = 0; i < inside->coordinate_count; i++) {
        nearest_offer(&search, inside->coordinates[i]->name);
    }
    diag_error(in->diags, name->at, parser_nearest(in, &search, NULL), "unknown coordinate %s",
               token_words(in, name));
}

void no_such_symbol(parser *in, const mechanism *of, const token *name) {
    nearest search = nearest_start(name->text, name->length);
    names_offer(of->names, -2, &search);
    diag_error(in->diags, name->at, parser_nearest(in, &search, NULL),
               "%s is unknown in mechanism '%s'", token_words(in, name), of->name);
}

const symbol *find_coordinate(parser *in, const token *name, const char *whose) {
    const named *found = names_find(in->names, name->text, name->length);
    if (found == NULL || (found->is_placeholder && found->symbol.kind == SYM_INPUT)) {
        no_such_coordinate(in, name);
    } else if (!found->is_placeholder && !symbol_moves(&found->symbol)) {
        diag_error(in->diags, name->at, NULL, "%s takes a coordinate, and %s is not one", whose,
                   token_words(in, name));
    } else if (!found->is_placeholder && name->primes > 0) {
        diag_error(in->diags, name->at, NULL, "%s takes a coordinate without primes", whose);
    } else if (!found->is_placeholder) {
        return &found->symbol;
    }
    return NULL;
}

/* === the grammar ============================================================================== */

static const expr *parse_sum(parser *in);
static const expr *parse_signed(parser *in);

static bool go_deeper(parser *in) {
    if (++in->nesting > NESTING_MAX) {
        return parser_fail(in, "name parts of the expression with let",
                           "this expression is nested more than %d deep", NESTING_MAX);
    }
    return true;
}

void parse_unit(parser *in, unit_scale *result, const char **text) {
    unit_error error;
    token unit = in->token;
    const bool bare = unit.kind == TOKEN_NAME;
    if (bare) {
        unit.length = unit.at.source->length - unit.at.offset;
    }
    const bool good = unit_parse(unit.text, unit.length, result, &error);
    if (!good) {
        diag_error(in->diags, place_after(unit.at, (bare ? 0 : 1) + error.offset), error.hint, "%s",
                   error.message);
        *result = (unit_scale){1.0, 1.0, dim_none(), enclosure_of(1.0)};
        result->dim.unknown = true;
    }
    char *dense = parser_copy_text(in, &unit);
    size_t length = 0;
    for (const char *from = dense; *from != '\0'; from++) {
        if (strchr(" \t\r\n", *from) == NULL) {
            dense[length++] = *from;
        }
    }
    dense[length] = '\0';
    *text = dense;
    do {
        parser_next(in);
    } while (bare && in->token.kind != TOKEN_END);
}

static const expr *parse_number(parser *in) {
    expr *made = expr_new(in, EXPR_NUMBER, in->token.at);
    made->number = in->token.number;
    made->exact = in->token.exact;
    made->dim.any = made->number == 0.0;
    parser_next(in);
    if (in->token.kind == TOKEN_UNIT || (in->bare_units && in->token.kind == TOKEN_NAME)) {
        const place bracket = in->token.at;
        const unit_scale *written = &in->number_unit;
        parse_unit(in, &in->number_unit, &in->number_unit_text);
        made->number = made->number * written->scale / written->divisor;
        made->exact = enclosure_mul(made->exact, written->exact);
        made->dim = written->dim;
        made->uses = USES_UNIT;
        if (!(made->number - made->number == 0.0)) {
            diag_error(in->diags, bracket, NULL, "in SI units this number is too large");
            made->number = 0.0;
        }
    }
    return made;
}

/* Reads the ')' that closes `open`. */
static bool parse_close(parser *in, place open) {
    if (parser_is_sign(in, ')')) {
        in->parentheses--;
        parser_next(in);
        return true;
    }
    const char *words = token_words(in, &in->token);
    if (in->token.kind == TOKEN_END || in->token.at.line != open.line) {
        if (in->token.kind != TOKEN_BAD) {
            diag_error(in->diags, open, NULL, "this parenthesis is not closed");
        }
        return false;
    }
    if (in->token.kind == TOKEN_NAME || in->token.kind == TOKEN_NUMBER) {
        return parser_fail(in, parser_operator_hint(in), "')' or an operator is missing before %s",
                           words);
    }
    if (in->token.kind == TOKEN_UNIT) {
        return parser_fail(in, "write a number before the unit: 2 [kg]", "a unit without a number");
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
    bool more = !parser_is_sign(in, ')');
    while (more && count < wanted) {
        arguments[count] = parse_sum(in);
        if (arguments[count++] == NULL) {
            return NULL;
        }
        more = parser_is_sign(in, ',');
        if (more) {
            parser_next(in);
        }
    }
    if (more || (count < wanted && parser_is_sign(in, ')'))) {
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
        diag_error(in->diags, name.at,
                   arena_words(in->arena, parser_is_sign(in, '^') ? "write %s(x)^2" : "write %s(x)",
                               function_name(function)),
                   "%s needs its argument in parentheses", function_name(function));
        return NULL;
    }
    if (parser_is_sign(in, '(') && !word_is_reserved(name.text, name.length)) {
        const char *hint = first_word_hint(name.text, name.length);
        nearest search = nearest_start(name.text, name.length);
        for (int f = 0; f < FUNCTIONS; f++) {
            nearest_offer(&search, function_name((function_id)f));
        }
        if (hint == NULL) {
            hint = parser_nearest(in, &search, NULL);
        }
        if (hint == NULL && names_find(in->names, name.text, name.length) != NULL) {
            hint = "write products with *; a coordinate has no (t)";
        } else if (hint == NULL) {
            hint = "the functions are";
            for (int f = 0; f < FUNCTIONS; f++) {
                hint = arena_words(in->arena, "%s%s %s", hint, f > 0 ? "," : "",
                                   function_name((function_id)f));
            }
        }
        diag_error(in->diags, name.at, hint, "there is no function %s", token_words(in, &name));
        return NULL;
    }
    return expr_name(in, &name);
}

static const expr *parse_any(parser *in);

static const expr *parse_primary(parser *in) {
    if (in->token.kind == TOKEN_NUMBER) {
        return parse_number(in);
    }
    if (in->token.kind == TOKEN_NAME) {
        return parse_named(in);
    }
    if (parser_is_sign(in, '(')) {
        const place open = in->token.at;
        const bool may_compare = in->token.text == in->condition_at;
        if (!go_deeper(in)) {
            return NULL;
        }
        in->parentheses++;
        parser_next(in);
        const expr *inner = may_compare ? parse_any(in) : parse_sum(in);
        if (inner == NULL || !parse_close(in, open)) {
            return NULL;
        }
        in->nesting--;
        return inner;
    }
    const char *words = token_words(in, &in->token);
    if (in->token.kind == TOKEN_NEWLINE) {
        parser_fail(in, "to continue on the next line, keep a parenthesis or brace open",
                    "a value is missing before the end of the line");
    } else if (in->token.kind == TOKEN_UNIT) {
        parser_fail(in, "write a number before the unit: 2 [kg]; there are no matrices",
                    "a unit without a number");
    } else {
        parser_fail(in, NULL, "a value is missing before %s", words);
    }
    return NULL;
}

static const expr *parse_power(parser *in) {
    const expr *base = parse_primary(in);
    if (base == NULL || base->is_condition || !parser_is_sign(in, '^')) {
        return base;
    }
    const place at = in->token.at;
    parser_next(in);
    if (!go_deeper(in)) {
        return NULL;
    }
    const expr *exponent = parse_signed(in);
    in->nesting--;
    return expr_binary(in, EXPR_POW, at, base, exponent);
}

static const expr *parse_signed(parser *in) {
    if (!parser_is_sign(in, '-') && !parser_is_sign(in, '+')) {
        return parse_power(in);
    }
    const token sign = in->token;
    if (!go_deeper(in)) {
        return NULL;
    }
    parser_next(in);
    const expr *operand = parse_signed(in);
    in->nesting--;
    return sign.sign == '+' ? operand : expr_negate(in, sign.at, operand);
}

/* Parses PART { sign PART } from left to right. The two signs have the same precedence. */
static const expr *parse_level(parser *in, const expr *(*part)(parser *), const char *signs,
                               expr_op first, expr_op second) {
    const expr *left = part(in);
    while (left != NULL && !left->is_condition &&
           (parser_is_sign(in, signs[0]) || parser_is_sign(in, signs[1]))) {
        const token sign = in->token;
        parser_next(in);
        if (sign.sign == '*' && parser_is_sign(in, '*')) {
            parser_fail(in, "write powers with ^: r^2", "'**' is no operator");
            return NULL;
        }
        left = expr_binary(in, sign.sign == signs[0] ? first : second, sign.at, left, part(in));
    }
    return left;
}

static const expr *parse_product(parser *in) {
    return parse_level(in, parse_signed, "*/", EXPR_MUL, EXPR_DIV);
}

static const expr *parse_sum(parser *in) {
    return parse_level(in, parse_product, "+-", EXPR_ADD, EXPR_SUB);
}

/* === the condition of a hold ================================================================== */
/* The condition of `hold ... while`:
 *
 *   condition  := both { or both }
 *   both       := comparison { and comparison }
 *   comparison := sum (> | >= | < | <=) sum | ( condition )
 *
 * A condition becomes one expression, which is above zero if the condition is true: a > b is a - b, `and` is min, `or`
 * is max. A parenthesis at the beginning of a comparison may enclose a condition or the beginning of a sum. */

static bool at_comparison(const parser *in) {
    return parser_is_sign(in, '>') || parser_is_sign(in, '<') ||
           parser_is_sign(in, SIGN_AT_LEAST) || parser_is_sign(in, SIGN_AT_MOST);
}

static const expr *missing_comparison(parser *in) {
    const bool equal = parser_is_sign(in, SIGN_EQUAL) || parser_is_sign(in, '=');
    parser_fail(in,
                equal ? "compare with >, <, >= or <=: two numbers are hardly ever equal"
                      : word_row(WORD_HOLD)->form,
                "a comparison is missing before %s", token_words(in, &in->token));
    return NULL;
}

static const expr *parse_comparison(parser *in) {
    in->condition_at = in->token.text;
    const expr *left = parse_sum(in);
    if (left == NULL || left->is_condition || !at_comparison(in)) {
        return left;
    }
    const token sign = in->token;
    const bool above = sign.sign == '>' || sign.sign == SIGN_AT_LEAST;
    parser_next(in);
    const expr *right = parse_sum(in);
    if (right == NULL) {
        return NULL;
    }
    if (at_comparison(in)) {
        parser_fail(in, "join two comparisons with 'and': x > a and x < b",
                    "a condition compares two expressions, not three");
        return NULL;
    }
    const expr *by = expr_difference(in, sign.at, above ? left : right, above ? right : left);
    if (by == NULL) {
        return NULL;
    }
    /* drop the dimension, so that `and` can join conditions of different dimensions */
    expr *made = expr_new(in, by->op, by->at);
    *made = *by;
    made->dim = dim_none();
    made->is_condition = true;
    return made;
}

/* Reads PART { word PART }. If there are several parts, each must be a condition. */
static const expr *parse_joined(parser *in, word_id word, function_id function,
                                const expr *(*part)(parser *)) {
    const expr *left = part(in);
    while (left != NULL && parser_is_word(in, word)) {
        const place at = in->token.at;
        if (!left->is_condition) {
            return missing_comparison(in);
        }
        parser_next(in);
        const expr *right = part(in);
        if (right == NULL || !right->is_condition) {
            return right == NULL ? NULL : missing_comparison(in);
        }
        left = expr_call(in, function, at, left, right);
    }
    return left;
}

static const expr *parse_both(parser *in) {
    return parse_joined(in, WORD_AND, FN_MIN, parse_comparison);
}

static const expr *parse_any(parser *in) { return parse_joined(in, WORD_OR, FN_MAX, parse_both); }

const expr *parse_condition(parser *in) {
    in->context = CONTEXT_EVENT;
    in->nesting = 0;
    const expr *made = parse_any(in);
    return made == NULL || made->is_condition ? made : missing_comparison(in);
}

const expr *parse_expression(parser *in, expr_context context) {
    in->context = context;
    in->nesting = 0;
    return parse_sum(in);
}

bool parse_assigned(parser *in, const token *name, const symbol *of, word_id statement,
                    const assignment **list, int *count) {
    const bool is_event = statement == WORD_WHEN;
    for (int i = 0; i < *count; i++) {
        const assignment *each = &(*list)[i];
        if (each->symbol == of && each->primes == name->primes) {
            diag_error(in->diags, name->at, NULL, "%s was already %s in line %d",
                       token_words(in, name), statement == WORD_START ? "given" : "set",
                       each->at.line);
        }
    }
    if (!parser_is_sign(in, '=')) {
        return parser_fail(in, is_event ? word_row(statement)->form : NULL,
                           "'=' is missing after %s, before %s", token_words(in, name),
                           token_words(in, &in->token));
    }
    parser_next(in);
    const place at = in->token.at;
    const expr *value = parse_expression(in, is_event ? CONTEXT_EVENT : CONTEXT_CONSTANT);
    if (value != NULL && of != NULL) {
        const assignment made = {of, name->primes, value, name->at};
        (void)check_value(in, at, value, of, name);
        *list = arena_push(in->arena, *list, count, &made, sizeof made);
    }
    return value != NULL;
}
