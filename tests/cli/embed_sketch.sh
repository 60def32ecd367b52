#!/bin/sh
# embed_sketch.sh: the sketch of docs/embedding.md in C++, with two scenes, one of them twice. It is built as a framework
# builds it and run with a small host program; hashes are equal. Also built for boards with each installed compiler.
. "$(dirname "$0")/../checks.sh"

awk '/^```cpp$/ { into = 1; next } /^```/ { into = 0 } into' docs/embedding.md >"$scratch/body"
{ echo '#include "Arduino.h"'; cat "$scratch/body"; } >"$scratch/sketch.cpp" # as a framework adds it
[ "$(wc -l <"$scratch/body")" -gt 30 ]
verdict $? "docs/embedding.md has a sketch"
for scene in epicyclic_from_rest thomson_a; do
    "$whirl" derive $scene --as c --header "$scratch/$scene.h" >"$scratch/$scene.c" 2>"$scratch/err"
    verdict $? "$scene is derived"
done
# Only what `make install` installs is compiled with the sketch.
env -u MAKEFLAGS -u MAKEOVERRIDES make -s install DESTDIR="$scratch/tree" PREFIX=/usr >"$scratch/err" 2>&1
verdict $? "make install DESTDIR= PREFIX="
installed=$scratch/tree/usr
"$installed/bin/whirl" derive thomson_a --as c 2>"$scratch/err" | cmp -s - "$scratch/thomson_a.c"
verdict $? "the installed program derives the same C"
core_in=$installed/share/whirl
sources="$core_in/core/scene.c $core_in/core/angle.c $core_in/core/text.c $scratch/epicyclic_from_rest.c $scratch/thomson_a.c"

# build CC CXX FLAGS...: the C as gnu11, the sketch as gnu++11; objects in $scratch.
build() {
    cc=$1
    cxx=$2
    shift 2
    : >"$scratch/err"
    for file in $sources; do
        $cc -std=gnu11 "$@" -Wall -Wextra -Werror -I"$core_in" -c "$file" -o "$scratch/$(basename "$file" .c).o" 2>>"$scratch/err" ||
            return 1
    done
    $cxx -std=gnu++11 -fno-exceptions -fno-rtti "$@" -Wall -Wextra -Wconversion -Wshadow -pedantic -Werror -I"$core_in" -Itests/embed \
        -I"$scratch" -c "$scratch/sketch.cpp" -o "$scratch/sketch.o" 2>>"$scratch/err"
}

hash_of() { sed -n "s/^$1 0x/0x/p" "$scratch/said"; }
hashes=tests/reference/bits.txt # recorded_bits.sh compares them with the interpreter's
"$whirl" run epicyclic_from_rest --set M=1.5 --number float >"$scratch/run"
gear=$(sed -n 's/^scene epicyclic_from_rest .* hash \(0x[0-9a-f]*\) ok$/\1/p' $hashes)
second=$(sed -n 's/^state hash *//p' "$scratch/run")
device=$(sed -n 's/^scene thomson_a .* hash \(0x[0-9a-f]*\) ok$/\1/p' $hashes)
[ -n "$gear" ] && [ -n "$second" ] && [ -n "$device" ] && [ "$gear" != "$second" ]
verdict $? "the record and whirl run tell what the sketch must come to"

for compiler in "gcc g++ -Os" "clang clang++ -O2"; do
    set -- $compiler
    command -v "$2" >/dev/null 2>&1 || continue
    build "$1" "$2" "$3" &&
        "$2" -std=gnu++11 -Itests/embed -o "$scratch/program" tests/embed/arduino_main.cpp "$scratch/sketch.o" "$scratch/scene.o" \
            "$scratch/angle.o" "$scratch/text.o" "$scratch/epicyclic_from_rest.o" "$scratch/thomson_a.o" 2>"$scratch/err"
    verdict $? "$2 $3 builds the sketch without a warning"
    "$scratch/program" 50001 >"$scratch/said" 2>"$scratch/err"
    [ "$(hash_of gear)" = "$gear" ] && [ "$(hash_of 'gear with 1.5 N\*m')" = "$second" ] &&
        [ "$(hash_of device)" = "$device" ]
    verdict $? "$2 $3: three runs at once end in the interpreter's bits" "$scratch/said"
    grep -Eq '^x_cm = -?[0-9.]+ m$' "$scratch/said"
    verdict $? "$2 $3: an output by its name and unit"
    flushing=$(gcc -print-file-name=crtfastmath.o) # linking with -ffast-math has the same effect: the start is refused
    [ "$flushing" != crtfastmath.o ] || continue
    "$2" -std=gnu++11 -Itests/embed -o "$scratch/flushing" tests/embed/arduino_main.cpp "$scratch/sketch.o" "$scratch/scene.o" \
        "$scratch/angle.o" "$scratch/text.o" "$scratch/epicyclic_from_rest.o" "$scratch/thomson_a.o" "$flushing" 2>"$scratch/err" &&
        "$scratch/flushing" 1000 >"$scratch/said" 2>"$scratch/err" && grep -q 'the arithmetic is not that of IEEE 754' "$scratch/said"
    verdict $? "$2 $3: a start that is refused ends the sketch cleanly"
done

! command -v arm-none-eabi-g++ >/dev/null 2>&1 || {
    build arm-none-eabi-gcc arm-none-eabi-g++ -Os -mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 -fno-math-errno
    verdict $? "arm-none-eabi-g++ compiles it for a Cortex-M4F"
}
! command -v avr-g++ >/dev/null 2>&1 || {
    build avr-gcc avr-g++ -Os -mmcu=atmega2560
    verdict $? "avr-g++ compiles it for an ATmega2560"
}

# The CMake project of docs/howto/firmware.md with the installed files, and with a path that has no core.
if command -v cmake >/dev/null 2>&1; then
    mkdir "$scratch/cmake"
    for block in 'c main.c' 'cmake CMakeLists.txt'; do
        awk -v head="\`\`\`$block" '$0 == head { into = 1; next } /^```/ { into = 0 } into' docs/howto/firmware.md >"$scratch/cmake/${block#* }"
    done
    (cd "$scratch/cmake" && "$installed/bin/whirl" new swing && "$installed/bin/whirl" derive swing.whirl --as c --header swing_swing.h >swing_swing.c &&
        cmake -S . -B build -DWHIRL="$core_in" && cmake --build build && ./build/swing >said) >"$scratch/err" 2>&1 &&
        grep -qx "$(cat "$scratch/cmake/said")" docs/howto/firmware.md
    verdict $? "the CMake project of docs/howto/firmware.md builds and prints what the page says"
    ! cmake -S "$scratch/cmake" -B "$scratch/cmake/wrong" -DWHIRL=nowhere >"$scratch/err" 2>&1 && grep -q 'not the absolute path' "$scratch/err"
    verdict $? "a WHIRL without the core stops CMake with a reason"
fi
cmp -s boards/shared/mem.c "$core_in/boards/shared/mem.c"
verdict $? "mem.c is installed"

env -u MAKEFLAGS -u MAKEOVERRIDES make -s uninstall DESTDIR="$scratch/tree" PREFIX=/usr >"$scratch/err" 2>&1 &&
    find "$scratch/tree" -type f >"$scratch/left" && [ ! -s "$scratch/left" ]
verdict $? "make uninstall leaves no file" "$scratch/left"
exit $failed
