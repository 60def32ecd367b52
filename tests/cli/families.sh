#!/bin/sh
# families.sh: a family of boards consists of its folders and its tests. Without them nothing names it, make builds and
# tests the others, and asks for no package that only it needs. Tried in a copy, with each family but the first.
. "$(dirname "$0")/../checks.sh"

here=$(pwd)
# folders_of FAMILY: prints its folder, and every folder whose makefile includes it directly or indirectly.
folders_of() {
    found=$1
    while :; do
        more=$(for folder in $found; do grep -l "^include boards/$folder/" boards/*/*.mk; done | cut -d / -f 2)
        all=$(printf '%s\n' $found $more | sort -u)
        [ "$all" != "$(printf '%s\n' $found | sort -u)" ] || break
        found=$all
    done
    echo $found
}

# without FAMILY: makes a copy of the tree without the family.
without() {
    tree=$scratch/without_$1
    mkdir "$tree"
    cp -r Makefile mk boards "$tree"
    for folder in core hal host tests docs; do
        ln -s "$here/$folder" "$tree/$folder"
    done
    mkdir "$tree/build"
    ln -s "$here/build/gen" "$tree/build/gen"
    for folder in $(folders_of "$1"); do
        rm -r "$tree/boards/$folder"
    done
}

plan() { # prints what make would do, and writes no file
    MAKEFLAGS= make -C "$tree" -n "$@" >"$scratch/plan" 2>"$scratch/err"
}

for family in avr riscv; do
    folders=$(folders_of $family)
    [ "$(for folder in $folders; do ls "boards/$folder/board.mk" 2>/dev/null; done | wc -l)" -ge 2 ]
    verdict $? "the folders of $family: $folders"
    without $family
    # Pages of measured prices name the boards that they show (mk/price, mk/price.mk, mk/curves.mk).
    for folder in $folders; do
        ! grep -rn "boards/$folder\b" "$tree/Makefile" "$tree/mk" "$tree/boards" >"$scratch/err"
        verdict $? "nothing names boards/$folder"
        ! grep -rnw -e "$folder" "$tree/Makefile" "$tree/mk" "$tree/boards" --include=*.mk --include=*.sh --include=Makefile |
            grep -v -e "/mk/price[./]" -e /mk/curves.mk -e ':[0-9]*:#' >"$scratch/err"
        verdict $? "nor $folder alone"
    done
    plan help
    verdict $? "make without $family"
    for board in mps2-an386 netduinoplus2; do
        plan BOARD=$board build/$board/station.elf && grep -q "$board" "$scratch/plan"
        verdict $? "it builds for $board"
    done
    plan board-own-objects
    verdict $? "and what only a board has"
    printf 'gates: ; @echo $(GATES) // $(BOARDS)\n' >>"$tree/Makefile"
    MAKEFLAGS= make -s -C "$tree" gates >"$scratch/gates" 2>"$scratch/err" && ! grep -qw $family "$scratch/gates" &&
        grep -qw house "$scratch/gates" && ! grep -qwF "$(printf '%s\n' $folders)" "$scratch/gates"
    verdict $? "it is no gate, and its boards are none" "$scratch/gates"
    "$tree/mk/setup/deps.sh" $family >"$scratch/out" 2>"$scratch/err"
    [ $? -eq 2 ]
    verdict $? "its packages are no group"
    packages=$(sed -n 's/^want \([^ ]*\).*/\1/p' boards/$family/packages.sh)
    asked() { (PATH=$scratch DEPS_DRY_RUN=1 exec /bin/sh "$1/mk/setup/deps.sh" boards) 2>&1 | grep -cwF "$packages"; }
    [ "$(asked "$here")" -ge 2 ] && [ "$(asked "$tree")" -eq 0 ]
    verdict $? "and none of them is asked for"
done
exit $failed
