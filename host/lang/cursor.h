/* cursor.h: the current token, tests on it, and recovery after errors. */
#ifndef LANG_CURSOR_H
#define LANG_CURSOR_H

#include "parser.h"
#include "words.h"

void parser_next(parser *in);
bool parser_is_sign(const parser *in, int sign);
bool parser_is_word(const parser *in, word_id word);
bool parser_at_end_of_line(const parser *in); /* newline, `;`, end of text */
bool token_is(const token *each, const char *word);
bool token_is_word(const token *each, word_id word);
/* The row of the statement that this token begins, or NULL. */
const statement_word *token_statement(const token *each);
bool parser_is_body_word(const parser *in); /* begins a statement of a file, mechanism or effect */
/* Does the token begin a line with a word that ends a block by this rule (ENDS_EFFECT, ...)? */
bool parser_leaves(const parser *in, unsigned rule);
/* Expect this word. If it is missing, report an error with the statement's usual form as a hint. */
bool parser_expect_word(parser *in, word_id word, word_id statement);
/* Report an error at the current token, unless the lexer has already reported it. Returns false. */
bool parser_fail(parser *in, const char *hint, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
bool parser_expect_sign(parser *in, int sign, const char *where);
/* The name of the token in messages, such as "'x'" or "the end of the line". */
const char *token_words(const token *each, char *buffer, size_t size);
/* Skip to the end of a failed statement, including the braces it opened. */
void parser_skip_statement(parser *in);
void parser_skip_lines(parser *in); /* skip empty lines */
/* The hint for a missing operator before the current name, number or '('; returns `hint`. */
enum { OPERATOR_HINT = 200 };
const char *parser_operator_hint(const parser *in, char hint[OPERATOR_HINT]);
bool parser_end_statement(parser *in, const char *what);
char *parser_copy_text(parser *in, const token *each);
/* An optional text in quotes; "" without one. */
const char *parser_title(parser *in);
/* Report that the current token begins no statement allowed here (IN_ bits); returns false. */
bool statement_unknown(parser *in, unsigned where);

#endif
