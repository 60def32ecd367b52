#!/bin/sh
# known_names.sh: finds names that C and C++ compilers reserve, by asking the compilers.
#
#     known_names.sh ask             prints candidates, one per line: all words of the headers and of the compilers'
#                                    own files
#     known_names.sh judge FILE CPP  prints the words of FILE (for C++, of CPP) that a compiler rejects as the name of an
#                                    object, or warns of. It tries without headers, with those of ISO C, and with those
#                                    to which GNU dialects add names
set -u
LC_ALL=C
export LC_ALL
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
iso="assert complex ctype fenv float inttypes limits locale math setjmp stdalign stdarg stdatomic stdbool stddef stdint \
    stdio stdlib stdnoreturn string tgmath threads time uchar wchar wctype"
gnu="math complex stdlib string strings"

: >"$scratch/none.h"
printf '#include <%s.h>\n' $iso >"$scratch/iso.h"
printf '#include <%s.h>\n' $gnu >"$scratch/gnu.h"

# strings_of FILE: prints the words of a file that stand alone between zero bytes or line ends
strings_of() { tr '\000' '\n' <"$1" | grep -axE '(__builtin_)?[a-z][a-z0-9_]{1,30}' | sed 's/^__builtin_//'; }
words() { grep -aohE '\b[A-Za-z][A-Za-z0-9_]*\b'; }

ask() {
    gcc -std=c11 -E -dD "$scratch/iso.h" 2>/dev/null | words
    gcc -std=gnu17 -E -dD "$scratch/gnu.h" 2>/dev/null | words
    gcc -std=gnu17 -E -dM -x c /dev/null | words
    for part in cc1 cc1plus; do
        file=$(gcc -print-prog-name=$part)
        [ -f "$file" ] && strings_of "$file"
    done
    file=$(clang -print-prog-name=clang 2>/dev/null)
    [ -n "$file" ] && for part in "$file" $(ldd "$file" | awk '/libclang-cpp/ { print $3 }'); do
        strings_of "$part"
    done
}

# judge_with COMPILER DIALECT HEADERS FILE
judge_with() {
    command -v "$1" >/dev/null 2>&1 || return 0
    case $1 in clang*) many="-ferror-limit=0 -fno-caret-diagnostics" ;; *) many= ;; esac
    case $1 in *++) language=c++ ;; *) language=c ;; esac
    {
        cat "$scratch/$3.h"
        echo "typedef struct wh_scene_ { int a; } wh_scene_;"
        echo "#line 1 \"names\""
        sed 's/.*/extern const wh_scene_ &;/' "$4"
    } >"$scratch/names.c"
    "$1" -x $language -std="$2" -Wall -Wextra -fsyntax-only $many "$scratch/names.c" 2>&1 | grep -E '^names:[0-9]+:' |
        sed -E 's/^names:([0-9]+):.*/\1/' | sort -un >"$scratch/lines"
    awk -v by="$1 -std=$2, headers $3" 'NR == FNR { bad[$1]; next } FNR in bad { print by ": " $0 }' "$scratch/lines" "$4"
}

case $1 in
ask) ask | sort -u ;;
judge)
    for compiler in gcc clang; do
        for dialect in c11 gnu17; do
            judge_with $compiler $dialect none "$2"
        done
        judge_with $compiler c11 iso "$2"
        judge_with $compiler gnu17 gnu "$2"
    done
    for compiler in g++ clang++; do
        judge_with $compiler gnu++20 none "$3"
    done
    ;;
esac
