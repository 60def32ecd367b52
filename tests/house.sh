#!/bin/sh
# house.sh: rules of this house that a search can check. Prints what breaks one.
set -u
bad=0

# rule "what is wrong" PATTERN FILE...: complain about every line that matches.
rule() {
    what=$1
    pattern=$2
    shift 2
    hits=$(grep -nE "$pattern" "$@" /dev/null 2>/dev/null)
    [ -z "$hits" ] && return
    echo "error: $what:"
    echo "$hits" | head -n 10 | sed 's/^/    /'
    bad=1
}

files() { find "$@" -type f \( -name '*.c' -o -name '*.h' \) 2>/dev/null | sort; }
core=$(files core)
hal=$(files hal)
target=$(files boards | grep -v '^boards/host/')
program=$(files host)
all=$(files core hal boards host mk tests)

# shellcheck disable=SC2086 # lists of files
{
    rule "a mark of something unfinished" '\b(TO''DO|FIX''ME|XX''X|HA''CK)\b' $all
    rule "heap in code for boards" '\b(malloc|calloc|realloc|free|alloca) *\(' $core $hal $target
    rule "a library header in code for boards" \
        '^#include <(stdio|stdlib|string|math|assert|time|errno|ctype|setjmp|signal)\.h>' \
        $core $hal $target
    rule "the core depends on nothing of ours" '^#include "(hal|boards|host|tests|build)/' $core
    rule "hal depends on the core only" '^#include "(boards|host|tests|build)/' $hal
    rule "the host's program depends on the core only" '^#include "(hal|boards|tests|build)/' $program
    rule "boards do not depend on the host's program" '^#include "(host|tests)/' $target
    rule "memory from the heap comes from host/base/room.c" \
        '\b(malloc|calloc|realloc|aligned_alloc|strdup|strndup|open_memstream) *\(' \
        $(files host | grep -v '^host/base/room\.c$')
    rule "white space at a line's end" '[[:space:]]$' $all
    rule "a tab" '	' $all
    for file in $all; do
        lines=$(wc -l <"$file")
        if [ "$lines" -gt 500 ]; then
            echo "error: $file has $lines lines: a file is one subject, most below 400, all below 500"
            bad=1
        fi
    done
}
exit $bad
