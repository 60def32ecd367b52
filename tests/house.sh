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
target=$(files boards | grep -v -e '^boards/host/' -e '^boards/[a-z0-9-]*/run/')
program=$(files host)
all=$(files core hal boards host mk tests)

# The includes that each folder may have, a line each. A line names only folders above it, so that there is no circle.
# Folders that run or write code know the image, but neither the language nor the algebra nor each other.
arrows='
core:
base: core
os: base core
number: core
lang: base number
algebra: base lang number
derive: algebra base core lang number
image: algebra base core derive lang number
show: algebra base derive image lang number
engine: base core image number os
emit: base image number
fixed: base core emit engine image number os
io: base core engine number os
check: base core engine image io number os
prove: base core engine image lang number os
study: base check core derive engine fixed image io lang number os
pil: base core engine image io number os
monitor: base core io number
cli: base check derive emit engine fixed image io lang monitor number os pil prove show study
'

# included FILE...: "FILE FOLDER" for each folder of core or host that a file names in an include
included() {
    grep -HoE '^#include "(host/[a-z]+|core)/' "$@" | sed -E 's/:#include "(host\/)?/ /; s/\/$//'
}

# arrows_hold: complain about every include that no line allows, and about lines that point down
arrows_hold() {
    known=
    for folder in $(echo "$arrows" | sed -n 's/:.*//p'); do
        allowed=$(echo "$arrows" | sed -n "s/^$folder: *//p")
        for other in $allowed; do
            case " $known " in
            *" $other "*) ;;
            *) echo "error: $folder: $other stands below it" && bad=1 ;;
            esac
        done
        known="$known $folder"
        [ "$folder" = core ] && continue
        [ -d "host/$folder" ] || { echo "error: there is no host/$folder" && bad=1; }
        hits=$(included $(files host/"$folder") | while read -r file other; do
            case " $folder $allowed " in
            *" $other "*) ;;
            *) echo "    $file includes $other" ;;
            esac
        done)
        [ -z "$hits" ] || { echo "error: an arrow between folders that is not allowed:" && echo "$hits" && bad=1; }
    done
    for folder in host/*/; do
        case " $known " in
        *" $(basename "$folder") "*) ;;
        *) echo "error: $folder is in no line of the arrows" && bad=1 ;;
        esac
    done
}
arrows_hold

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
    rule "memory from the heap comes from host/base/alloc.c" \
        '\b(malloc|calloc|realloc|aligned_alloc|strdup|strndup|open_memstream) *\(' \
        $(files host | grep -v '^host/base/alloc\.c$')
    rule "a step of a sweep knows the image only" '^#include "host/(lang|algebra|derive)/' host/study/stepping.* \
        host/study/gauge.*
    rule "runs are stepped by host/engine/loop.c alone; host/pil/plant.c is paced by firmware" \
        '(->|engine_[a-z]+\.)step *\(' $(files host | grep -vxE 'host/(engine/loop|pil/plant)\.c')
    rule "white space at a line's end" '[[:space:]]$' $all
    rule "a tab" '	' $all
    twice=$(files core hal host | sed 's/\.[ch]$//; s:/posix/:/:' | sort -u | sed 's:.*/::' | sort | uniq -d)
    for name in $twice; do
        echo "error: files of one program have one name: $(files core hal host | grep "/$name\.[ch]$" | tr '\n' ' ')"
        bad=1
    done
    for file in $all; do
        lines=$(wc -l <"$file")
        if [ "$lines" -gt 1200 ]; then
            echo "error: $file has $lines lines: a file is one subject, in sections, and no subject needs 1,200"
            bad=1
        fi
    done
}
# A row of mk/mutants that no longer changes anything tests nothing: its line of code was rewritten.
# shellcheck disable=SC2034 # suites
hits=$(grep -hv '^#' mk/mutants/*.rows | while IFS='@' read -r name file change suites; do
    file=$(echo "$file" | tr -d ' ')
    changed=$(sed "$(echo "$change" | sed 's/^ *//; s/ *$//')" "$file" | cmp "$file" - 2>/dev/null)
    [ -n "$changed" ] || echo "    $file: $name"
done)
[ -z "$hits" ] || { echo "error: a row of mk/mutants that finds nothing:" && echo "$hits" && bad=1; }
# Prose has lines of at most 100 characters; tables, code and what follows a bracket without a blank cannot be cut.
# Bytes that continue a character of UTF-8 are not counted.
for page in README.md CONTRIBUTING.md CHANGELOG.md $(ls docs/*.md docs/dev/*.md | grep -v figures.md); do 
    LC_ALL=C sed 's/[\x80-\xbf]//g' "$page" | awk -v page="$page" '
        /^ *```/ { code = !code }
        !code && !/^\|/ && !/^    / && !/^`/ && length > 100 && /[^ ] [^ ]/ {
            print "error: " page ":" NR ": a line of more than 100 characters"; bad = 1 }
        END { exit bad }' || bad=1
done
exit $bad
