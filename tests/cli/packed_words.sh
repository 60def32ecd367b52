#!/bin/sh
# packed_words.sh: what mk/size/pack.awk packs comes back to the letter (core/packed_words.h): all that the firmware says, and random words.
. "$(dirname "$0")/../checks.sh"

cc=${CC:-cc}
pack() { awk -f mk/size/pack.awk core/word_pairs.h "$1"; }

# Files that have such words, behind the preprocessor; those of chips are not for this machine.
grep -lE 'WH_(WORDS|SAY)\(' core/*/*.c >"$scratch/files"
while read -r file; do
    "$cc" -std=c11 -I. -DWH_WORDS_PACKED=1 -E "$file"
done <"$scratch/files" >"$scratch/said" 2>"$scratch/err"
verdict $? "$(wc -l <"$scratch/files") files"
grep -o 'WH_PACK_THESE_WORDS("[^"]*")' "$scratch/said" >"$scratch/calls"
[ "$(wc -l <"$scratch/calls")" -gt 100 ]
verdict $? "$(wc -l <"$scratch/calls") texts in them"
# And 300 of any characters but quote, backslash and question mark.
awk -v seed="${WHIRL_SEED:-1}" 'BEGIN {
    srand(seed)
    for (i = 0; i < 300; i++) {
        words = ""
        for (left = int(60 * rand()); left > 0; left--) {
            do { c = sprintf("%c", 32 + int(95 * rand())) } while (c == "\"" || c == "\\" || c == "?")
            words = words c
        }
        print "WH_PACK_THESE_WORDS(\"" words "\")"
    }
}' >>"$scratch/calls"
{
    echo '#include "core/packed_words.h"'
    echo '#include <stdio.h>'
    echo '#include <string.h>'
    echo 'static const char *const texts[][2] = {'
} >"$scratch/texts.c"
sed 's/^WH_PACK_THESE_WORDS(\(.*\))$/{WH_PACK_THESE_WORDS(\1), \1},/' "$scratch/calls" >>"$scratch/texts.c"
cat >>"$scratch/texts.c" <<'END'
};
int main(void) {
    size_t plain = 0, packed = 0;
    const size_t count = sizeof texts / sizeof texts[0];
    int wrong = 0;
    for (size_t i = 0; i < count; i++) {
        char bytes[200];
        wh_text text;
        wh_text_start(&text, bytes, sizeof bytes);
        wh_words_unpack(&text, texts[i][0]);
        wrong += strcmp(bytes, texts[i][1]) != 0;
        if (i + 300 < count) {
            plain += strlen(texts[i][1]);
            packed += strlen(texts[i][0]);
        }
    }
    printf("%zu texts, %d wrong; the firmware's %zu bytes are %zu\n", count, wrong, plain, packed);
    return wrong > 0 || 10 * packed > 6 * plain;
}
END
pack "$scratch/texts.c" >"$scratch/packed.c" 2>"$scratch/err"
verdict $? "they are packed"
"$cc" -std=c11 -I. -o "$scratch/texts" "$scratch/packed.c" core/packed_words.c core/text.c 2>"$scratch/err"
verdict $? "and compiled"
"$scratch/texts" >"$scratch/err"
verdict $? "$(cat "$scratch/err")"

# What cannot be packed is refused, not left as it is.
for words in '"a\\n"' '"a" "b"' 'name'; do
    printf 'const char *x = WH_PACK_THESE_WORDS(%s);\n' "$words" >"$scratch/odd.c"
    ! pack "$scratch/odd.c" >"$scratch/out" 2>"$scratch/err" && grep -q 'holds one literal' "$scratch/err"
    verdict $? "WH_WORDS($words) is refused" "$scratch/out"
done

exit $failed
