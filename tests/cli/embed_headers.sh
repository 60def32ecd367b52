#!/bin/sh
# embed_headers.sh: headers for firmware compile without warnings as C11 and C++11 and later, strict and GNU, in float and
# double, among a framework's macros. Functions have C linkage, headers for C only say so, names tell the two builds apart,
# and no compiler sees an unknown pragma.
. "$(dirname "$0")/../checks.sh"

root=$(pwd)
gen="$(dirname "$whirl")/gen"
[ -d "$gen" ] || gen=build/gen
warnings="-Wall -Wextra -Wconversion -Wshadow -Wdouble-promotion -Wundef -pedantic -Werror -ffp-contract=off"

only_c=$(ls core/rk4.h core/step.h core/contact.h core/contact/*.h core/step/*.h core/number/arithmetic.h core/number/sincos_small.h core/function_*.h)
public=$( (ls core/*.h core/number/*.h core/rig/*.h hal/*.h hal/virtual/*.h boards/board.h; echo "$only_c" "$only_c") |
    tr ' ' '\n' | sort | uniq -u)
scenes=$(cd "$gen" && ls ./*.h | sed 's|^\./||')

have() { command -v "$1" >/dev/null 2>&1; }

{
    echo '#include "tests/embed/Arduino.h"'
    printf '#include "%s"\n' $public $scenes
    printf '#include "%s"\n' $public # twice does no harm
} >"$scratch/all.c"
cp "$scratch/all.c" "$scratch/all.cpp"

# quiet WHAT COMPILER FLAG...: succeeds without any message.
quiet() {
    what=$1
    shift
    "$@" $warnings -I. -I"$gen" -I"$scratch" >"$scratch/err" 2>&1 && [ ! -s "$scratch/err" ]
    verdict $? "$what"
}

for real in 0 1; do
    for standard in c11 gnu11 gnu17; do
        for compiler in gcc clang arm-none-eabi-gcc; do
            ! have $compiler || quiet "all headers, $compiler -std=$standard, WH_DOUBLE=$real" \
                $compiler -std=$standard -DWH_DOUBLE=$real -fsyntax-only "$scratch/all.c"
        done
    done
    for standard in c++11 gnu++11 c++17 c++20; do
        for compiler in g++ clang++ arm-none-eabi-g++; do
            ! have $compiler || quiet "all headers, $compiler -std=$standard, WH_DOUBLE=$real" \
                $compiler -std=$standard -DWH_DOUBLE=$real -fsyntax-only "$scratch/all.cpp"
        done
    done
done

# --- each header by itself --------------------------------------------------------------------------
alone=0
: >"$scratch/err"
some=$(echo "$scenes" | grep -E '^(scenes|thomson_a|ball_bounces|carriage_stop)\.h$') # all are of one kind
for header in $public $some; do
    printf '#include "%s"\ntypedef int one;\n' "$header" | tee "$scratch/one.c" >"$scratch/one.cpp"
    { gcc -std=c11 $warnings -I. -I"$gen" -fsyntax-only "$scratch/one.c" &&
        g++ -std=c++11 $warnings -I. -I"$gen" -fsyntax-only "$scratch/one.cpp"; } >>"$scratch/err" 2>&1 &&
        alone=$((alone + 1))
done
[ "$alone" -eq "$(echo "$public $some" | wc -w)" ] && [ "$alone" -gt 20 ] && [ ! -s "$scratch/err" ]
verdict $? "$alone headers compile each by itself, as C11 and as C++11"

# --- C only -----------------------------------------------------------------------------------------
for header in $only_c; do
    echo "#include \"$header\"" >"$scratch/one.cpp"
    g++ -std=c++11 -I. -fsyntax-only "$scratch/one.cpp" 2>&1 | grep -m 1 'error' >"$scratch/err"
    grep -q '#error "core/.*\.h is C only' "$scratch/err"
    verdict $? "$header says first of all that it, or a header that it includes, is C only"
done

# --- names ------------------------------------------------------------------------------------------
mkdir "$scratch/float" "$scratch/double"
# compile FILE...: makes the files' objects in both folders.
compile() {
    for real in float double; do
        [ $real = double ] && double=1 || double=0
        for file in "$@"; do
            gcc -std=c11 -ffp-contract=off -I. -DWH_DOUBLE=$double -O1 -c "$file" \
                -o "$scratch/$real/$(basename "$file" .c).o" 2>"$scratch/err" || verdict 1 "$file compiles in $real"
        done
    done
}
compile core/*.c

# names FOLDER: prints the names that its objects define for others.
names() {
    nm -g --defined-only "$1"/*.o | awk 'NF == 3 && $3 !~ /^__/ { print $3 }' | sort -u
}
# apart: prints names of the double build that do not end in _d, and names of the float build that do.
apart() {
    names "$scratch/float" >"$scratch/float.names"
    names "$scratch/double" >"$scratch/double.names"
    grep '_d$' "$scratch/float.names"
    grep -v '_d$' "$scratch/double.names"
}
apart >"$scratch/err"
[ "$(wc -l <"$scratch/float.names")" -ge 40 ] && [ ! -s "$scratch/err" ]
verdict $? "every name of the double core ends in _d, none of the float core: $(wc -l <"$scratch/double.names") and $(wc -l <"$scratch/float.names")"
gcc -r -nostdlib -o "$scratch/both.o" "$scratch"/float/*.o "$scratch"/double/*.o 2>"$scratch/err"
verdict $? "both cores link into one program"
echo 'int wh_planted(void); int wh_planted(void) { return 1; }' >"$scratch/planted.c"
compile "$scratch/planted.c"
apart | grep -q wh_planted
verdict $? "a function without WH_NAME is noticed"
rm "$scratch"/*/planted.o
compile core/rig/*.c

# C++ finds every declared name under that name: C linkage.
declared() { # declared REAL KIND: names of this build that a public header has
    grep -how 'wh_[a-z0-9_]*' $public | sort -u >"$scratch/words"
    nm -g --defined-only "$scratch/$1"/*.o | awk -v kind="$2" -v words="$scratch/words" '
        BEGIN { while ((getline word <words) > 0) known[word] = 1 }
        $2 ~ "^" kind "$" { name = $3; sub(/_d$/, "", name); if (name in known) print $3 }'
}
for real in float double; do
    [ $real = double ] && double=1 || double=0
    {
        printf '#include "%s"\n' $(ls core/*.h core/number/*.h core/rig/*.h | grep -vxF "$only_c")
        echo 'typedef void any(); extern const volatile void *const data[]; extern any *const code[];'
        echo 'const volatile void *const data[] = {'
        declared "$real" '[RD]' | sed 's/.*/    \&&,/'
        echo '    0}; any *const code[] = {'
        declared "$real" T | sed 's/.*/    reinterpret_cast<any *>(\&&),/'
        echo '    0}; int main() { return data[0] == 0 || code[0] == 0; }'
    } >"$scratch/linked.cpp"
    g++ -std=c++11 -DWH_DOUBLE=$double -I. -o "$scratch/linked" "$scratch/linked.cpp" "$scratch/$real"/*.o \
        >"$scratch/err" 2>&1 && "$scratch/linked"
    status=$?
    [ "$(declared $real '[RDT]' | wc -l)" -ge 40 ] || status=1
    verdict $status "C++ finds every function and constant that the headers declare, $real: $(declared $real '[RDT]' | wc -l)"
done

# --- pragmas ----------------------------------------------------------------------------------------
# Older compilers are imitated by their version number; avr-gcc 5.4 is one.
"$whirl" derive thomson_a --as c >"$scratch/scene.c"
for version in 5 6 7 8 12; do
    gcc -std=c11 -U__GNUC__ -D__GNUC__=$version -w -I. -E "$scratch/scene.c" >"$scratch/preprocessed" 2>"$scratch/err"
    unrolls=$(grep -c 'pragma GCC unroll' "$scratch/preprocessed")
    if [ $version -lt 8 ]; then [ "$unrolls" -eq 0 ]; else [ "$unrolls" -gt 0 ]; fi
    verdict $? "gcc $version sees $unrolls pragmas that unroll: they came with gcc 8"
done

# --- generated and core files compile as every standard of C, strict and GNU ---------------------------
for standard in c11 gnu11 gnu17; do
    : >"$scratch/err"
    for file in core/*.c core/rig/*.c "$scratch/scene.c" "$gen/thomson_magnet.c" "$gen/carriage_stop.c"; do
        gcc -std=$standard $warnings -I. -I"$root" -fsyntax-only "$file" >>"$scratch/err" 2>&1
    done
    [ ! -s "$scratch/err" ]
    verdict $? "the core and generated C, -std=$standard -pedantic"
done

# --- a header and the .c of another version of the scene do not link, and the check costs no byte ---------------------
# pair FOLDER NAMES K LINE TEXT OPTION...: writes the header and .c of masses on springs; the file has this line and this text.
pair() {
    folder=$scratch/$1
    mkdir "$folder"
    {
        echo "mechanism pair \"$5\""
        for name in $2; do echo "coordinate $name [m] \"$5 $name\""; done
        printf 'parameter k = %s [N/m]\n%b\n' "$3" "$4"
        echo "T = $(for name in $2; do printf '1 [kg]*%s'\''^2/2 + ' "$name"; done)0 [J]"
        echo "V = $(for name in $2; do printf 'k*%s^2/2 + ' "$name"; done)0 [J]"
        echo "scene stroke { start a = 1 [m]; step 1 [ms]; until 1 [s]; range a = -2 .. 2 [m] }"
    } >"$folder/pair.whirl"
    shift 5
    "$whirl" derive "$folder/pair.whirl" --as c "$@" --header "$folder/stroke.h" >"$folder/stroke.c" 2>"$scratch/err" ||
        verdict 1 "$folder"
}
echo '#include "stroke.h"
const void *scene(void); const void *scene(void) { return &stroke; }
unsigned long words(void); unsigned long words(void) { return stroke_MEMORY_WORDS; }' | tee "$scratch/main.c" >"$scratch/main.cpp"
# asked COMPILER FOLDER: the name that the header of FOLDER requires, and that its .c defines
asked() { $1 $warnings -I. -I"$scratch/$2" -c -o "$scratch/o.o" "$scratch/main.${3:-c}" 2>>"$scratch/said" && nm "$scratch/o.o" | sed -n 's/.* U //p' | grep stroke; }
given() { $1 $warnings -I. -c -o "$scratch/o.o" "$scratch/$2/stroke.c" 2>>"$scratch/said" && nm "$scratch/o.o" | sed -n 's/.* [RDV] //p' | grep stroke_H; }
names=$(awk 'BEGIN { srand(5); n = split("a b c d e", w); for (i = n; i > 1; i--) { j = 1 + int(i*rand()); t = w[i]; w[i] = w[j]; w[j] = t }
    for (i = 1; i <= n; i++) printf "%s ", w[i] }') # drawn, and turned by one below
for number in float fixed; do
    pair of_$number "$names" 9 '' text --number $number
    pair text_$number "$names" 9 '# a comment\n' 'another text' --number $number
    pair effect_$number "$names" 9 'effect rub { parameter drag = 1 [N*s/m]; F += drag*a'\''^2/2 }' text --number $number
    pair order_$number "${names#* }${names%% *}" 9 '' text --number $number
    pair value_$number "$names" 9.5 '' text --number $number
    pair output_$number "$names" 9 'output twice [m] = 2*a' text --number $number
    pair step_$number "$names" 9 '' text --number $number --step 0.5ms
    for compiler in gcc clang arm-none-eabi-gcc avr-gcc; do
        { [ $number = float ] || [ $compiler = gcc ]; } && have $compiler || continue
        some="of text order"
        [ $compiler != gcc ] || some="of text effect order value output step"
        : >"$scratch/said"
        same=$(asked "$compiler" of_$number)
        wrong=''
        for folder in $some; do
            own=$(given "$compiler" ${folder}_$number)
            case $folder in
            of | text | effect) [ "$own" = "$same" ] ;;
            *) [ "$own" != "$same" ] && [ "$own" = "$(asked "$compiler" ${folder}_$number)" ] ;;
            esac || wrong="$wrong $folder"
        done
        [ -n "$same" ] && [ -z "$wrong" ] && [ ! -s "$scratch/said" ]
        verdict $? "$compiler, $number: only a header of the same scene links to its .c$wrong" "$scratch/said"
    done
    [ "$(asked "g++ -std=c++11 -Wold-style-cast" of_$number cpp)" = "$(given gcc of_$number)" ]
    verdict $? "g++, $number: the same name"
    size "$scratch/o.o" >"$scratch/with"
    sed '/^WH_LINKED_AS/d' "$scratch/of_$number/stroke.c" >"$scratch/text_$number/stroke.c"
    ! given gcc text_$number >/dev/null && size "$scratch/o.o" | cmp -s - "$scratch/with"
    verdict $? "$number: the second name takes no byte" "$scratch/with"
done
exit $failed
