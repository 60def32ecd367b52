#!/bin/sh
# embed_names.sh: `whirl derive --as c --header FILE`: names, units and places for C and C++, and the memory, which must be
# exactly what wh_scene_start() requires. For built-in scenes and generated ones with awkward names and texts, with or
# without compensated sums and energy balance, in float and double. WHIRL_SEED and WHIRL_CASES change the generated ones;
# WHIRL_FULL=1 takes three times as many.
. "$(dirname "$0")/../checks.sh"
regex=-E

build=$(dirname "$whirl")
gen=build/gen
flags="-ffp-contract=off -I. -I$gen -I$scratch -Wall -Wextra -Wconversion -Wshadow -pedantic -Werror"


# --- mistakes ---------------------------------------------------------------------------------------------
"$whirl" derive --help | grep -q -- '--header FILE'
verdict $? "--help tells of it"
exits 2 'error: --header needs a value' derive thomson_a --as c --header
exits 2 'error: --header needs --as c' derive thomson_a --header "$scratch/x.h"
exits 2 'hint: --as c --header FILE' derive thomson_a --as latex --header "$scratch/x.h"
[ ! -e "$scratch/x.h" ]
verdict $? "nothing is written then"
exits 2 'error: --header needs the name of a file, because standard output' derive thomson_a --as c --header -
exits 2 'error: --header needs the name of a file, because standard output' derive thomson_a --as c --header=
exits 2 "unknown option '--haeder'" derive thomson_a --as c --haeder x.h
grep -q 'hint: did you mean --header' "$scratch/err"
verdict $? "and a hint"
printf 'mechanism own\ncoordinate x [m]\nT = 2 [kg]*x'"'"'^2/2\n' >"$scratch/own.whirl"
cp "$scratch/own.whirl" "$scratch/kept"
ln -s own.whirl "$scratch/soft"
ln "$scratch/own.whirl" "$scratch/hard"
for file in own.whirl soft hard; do
    exits 2 "error: --header would overwrite $scratch/own.whirl" derive "$scratch/own.whirl" --as c --header "$scratch/$file"
done
cmp "$scratch/own.whirl" "$scratch/kept"
verdict $? "the model is as it was"
echo kept >"$scratch/c.c"
"$whirl" derive "$scratch/own.whirl" --as c --header "$scratch/c.c" >>"$scratch/c.c" 2>"$scratch/err"
[ $? -eq 2 ] && grep -q 'error: --header and standard output cannot share a file' "$scratch/err" && [ "$(cat "$scratch/c.c")" = kept ]
verdict $? "--header and standard output cannot share a file"

# The compiler decides which scenes C++ could not name.
for word in alignas alignof and and_eq asm bitand bitor catch char16_t char32_t class compl const_cast constexpr decltype \
    delete dynamic_cast explicit export friend mutable namespace new noexcept not not_eq nullptr operator or or_eq private \
    protected public reinterpret_cast static_assert static_cast template this thread_local throw try typeid typename \
    using virtual wchar_t xor xor_eq char8_t concept consteval constinit co_await co_return co_yield requires \
    override final import module; do
    echo "mechanism $word coordinate x [m]" | sed 's/ coordinate/\ncoordinate/' >"$scratch/word.whirl"
    echo "T = 2 [kg]*x'^2/2" >>"$scratch/word.whirl"
    echo "extern const int $word;" >"$scratch/word.cpp"
    "$whirl" derive "$scratch/word.whirl" --as c --header "$scratch/word.h" >/dev/null 2>"$scratch/said"
    status=$?
    if g++ -std=c++20 -fsyntax-only "$scratch/word.cpp" 2>/dev/null; then wanted=0; else wanted=2; fi
    [ $status -eq $wanted ] && { [ $status -eq 0 ] || grep -q "'$word' is a word of C" "$scratch/said"; } ||
        verdict 1 "a scene of the name '$word': exit status $status, not $wanted" "$scratch/said"
done
verdict 0 "scenes with names that are words of C++ are refused, where a header is asked for"

# Names that a generated file uses itself are refused, or cause no warning. tests/host/test_c_names.c covers the names
# of compilers and headers.
for one in "carriage_stop --with ledger" "ball_between" "thomson_b_conserved --compensated" rig_fixed; do
    "$whirl" derive $one --as c
done 2>/dev/null | sed 's|/\*.*\*/||; s/^ \*.*//; s/"[^"]*"//g' | grep -oE '\b[A-Za-z_][A-Za-z0-9_]*\b' | sort -u |
    grep -vE '^(wh_|WH_|[xsc][0-9]*[02-9]$|.*[0-9a-f]p$)' >"$scratch/words"
own="spring rig motor first_turn WH wh errno fabsf unix I"
known=0
for word in $own $(cat "$scratch/words"); do
    "$whirl" derive carriage_stop --with ledger --as c --name "$word" --header "$scratch/word.h" >"$scratch/word.c" \
        2>"$scratch/said" || continue
    echo '#include "word.h"' >"$scratch/uses.cpp"
    for compiler in gcc clang; do
        $compiler -std=c11 $flags -fsyntax-only "$scratch/word.c" 2>"$scratch/said" ||
            verdict 1 "a scene of the name '$word' does not compile by $compiler" "$scratch/said"
    done
    g++ -std=gnu++17 -I. -I"$scratch" -fsyntax-only "$scratch/uses.cpp" 2>"$scratch/said" ||
        verdict 1 "a program in C++ cannot include a scene of the name '$word'" "$scratch/said"
    known=$((known + 1))
done
words=$(wc -l <"$scratch/words")
[ "$words" -gt 60 ] && [ $known -ge 40 ] && [ $((words - known)) -ge 20 ]
verdict $? "scenes with names that a generated file has itself are refused, others compile: $known of $words"

# --- every built-in scene ------------------------------------------------------------------------------------
scenes=$("$whirl" list | awk '$1 == "scene" { print $2 }')
in_gen=""
for scene in $scenes; do
    [ ! -e "$gen/$scene.h" ] || in_gen="$in_gen $scene"
done

# memory SCENE...: a program that starts each scene with the memory that its header states, and with one byte less.
memory() {
    printf '#include "%s.h"\n' "$@"
    cat <<'END'
#include "core/ledger.h"
#include <stdio.h>
static const struct told {
    const wh_scene *scene;
    size_t bytes, words;
    int angles, reals, inputs, outputs, contacts;
} all[] = {
END
    for one in "$@"; do
        echo "{&$one, ${one}_MEMORY_BYTES, ${one}_MEMORY_WORDS, ${one}_ANGLES, ${one}_REALS, ${one}_INPUTS, ${one}_OUTPUTS, ${one}_CONTACTS},"
    done
    cat <<'END'
};
static uint64_t memory[2000];
int main(void) {
    int bad = 0;
    for (unsigned i = 0; i < sizeof all / sizeof all[0]; i++) {
        const struct told *t = &all[i];
        const wh_scene *s = t->scene;
        wh_state state;
        const int right = wh_scene_start(s, &state, memory, t->bytes) == WH_OK &&
                          wh_scene_start(s, &state, memory, t->bytes - 1U) == WH_E_MEMORY &&
                          t->words * 8U >= t->bytes && t->words * 8U < t->bytes + 8U && t->angles == s->angles &&
                          t->reals == s->reals && t->inputs == s->inputs && t->outputs == s->outputs &&
                          t->contacts == s->contacts;
        if (!right) {
            printf("%s: %lu bytes\n", s->name, (unsigned long)t->bytes);
            bad++;
        }
    }
    return bad != 0;
}
END
}
memory $in_gen | tee "$scratch/memory.c" >"$scratch/memory.cpp"
for real in float double; do
    [ $real = double ] && double=1 || double=0
    sanitize=""
    ! nm "$build/$real/libscenes.a" 2>/dev/null | grep -q __asan_init || sanitize="-fsanitize=address,undefined"
    for language in "gcc -std=c11 .c" "g++ -std=c++11 .cpp"; do
        set -- $language
        "$1" "$2" $flags $sanitize -DWH_DOUBLE=$double -o "$scratch/memory" "$scratch/memory$3" "$build/$real/libscenes.a" \
            "$build/$real/libwhirl.a" -lm >"$scratch/err" 2>&1 && "$scratch/memory" >"$scratch/err" 2>&1
        verdict $? "$(echo $in_gen | wc -w) built-in scenes take what their headers say and no byte less: $1 $2, $real"
    done
done

# --- generated scenes ------------------------------------------------------------------------------------------
seed=${WHIRL_SEED:-$(date +%j)}
cases=${WHIRL_CASES:-${WHIRL_FULL:+12}}
[ -z "${WHIRL_FEW:-}" ] || cases=${cases:-2} # in the sanitizers' gate
cases=${cases:-4} # one of each set of options
echo "seed $seed, $cases cases (WHIRL_SEED, WHIRL_CASES)"
made=""
number=0
while [ $number -lt "$cases" ]; do
    name=$(awk -v seed="$seed" -v number=$number -v folder="$scratch" -f tests/embed/names.awk)
    case $((number % 4)) in
    0) options="" ;;
    1) options="--compensated --with ledger" ;;
    2) options="--compensated" ;; # because systems have no energies
    3) options="--with ledger" ;;
    esac
    [ $((number % 3)) -ne 2 ] || options=${options%--with ledger}
    if "$whirl" derive "$scratch/$number.whirl" --as c $options --header "$scratch/$name.h" >"$scratch/$number.c" 2>"$scratch/err"; then
        made="$made $name"
    else
        verdict 1 "case $number of seed $seed is derived"
    fi
    number=$((number + 1))
done
{
    memory $made | sed 's/^int main(void)/static int memories(void)/'
    cat <<'END'
#include <string.h>
#define CHECK(condition) (condition) ? (void)0 : (void)(bad++, printf("%s\n", #condition))
static int bad = 0;
static int same(const char *one, const char *other) { return strcmp(one, other) == 0; }
static int near(wh_real one, wh_real other) { return WH_ABS(one - other) < WH_R(1e-6); }
END
    number=0
    for name in $made; do
        echo "static void check_$number(void) {"
        for list in ANGLES REALS INPUTS OUTPUTS; do
            lower=$(echo $list | tr '[:upper:]' '[:lower:]')
            grep -q "${name}_UNITS_OF_$list" "$scratch/$name.h" || continue
            echo "    static const char *const of_$lower[] = ${name}_NAMES_OF_$list;"
            echo "    static const char *const in_$lower[] = ${name}_UNITS_OF_$list;"
            echo "    CHECK(sizeof of_$lower / sizeof of_$lower[0] == ${name}_$list);"
            echo "    CHECK(sizeof in_$lower / sizeof in_$lower[0] == ${name}_$list);"
        done
        echo "    static uint64_t room[${name}_MEMORY_WORDS]; wh_state state; wh_real output[${name}_OUTPUTS];"
        echo "    CHECK(wh_scene_start(&$name, &state, room, sizeof room) == WH_OK);"
        echo "    $name.observe(&$name, &state, output);"
        cat "$scratch/$number.checks"
        echo "    CHECK($name.ledger == NULL || ${name}_ACCOUNTS > 1);"
        echo "}"
        number=$((number + 1))
    done
    echo 'int main(void) {'
    for one in $(seq 0 $((number - 1))); do echo "    check_$one();"; done
    echo '    return memories() + bad; }'
} >"$scratch/checks.c"
cp "$scratch/checks.c" "$scratch/checks.cpp"
for real in float double; do
    [ $real = double ] && double=1 || double=0
    mkdir -p "$scratch/$real"
    : >"$scratch/err"
    for file in "$scratch"/[0-9]*.c core/scene.c core/angle.c; do
        gcc -std=c11 $flags -O0 -DWH_DOUBLE=$double -c "$file" -o "$scratch/$real/$(basename "$file" .c).o" 2>>"$scratch/err"
    done
    [ ! -s "$scratch/err" ]
    verdict $? "generated scenes compile without a word, $real"
    for language in "gcc -std=c11 .c" "g++ -std=c++11 .cpp" "clang++ -std=c++20 .cpp"; do
        set -- $language
        command -v "$1" >/dev/null 2>&1 || continue
        "$1" "$2" $flags -DWH_DOUBLE=$double -o "$scratch/checks" "$scratch/checks$3" "$scratch/$real"/*.o -lm >"$scratch/err" 2>&1 &&
            "$scratch/checks" >"$scratch/err" 2>&1
        verdict $? "their headers are right: $1 $2, $real (seed $seed)"
    done
done
exit $failed
