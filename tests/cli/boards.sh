#!/bin/sh
# boards.sh: make refuses a board.mk with a missing or wrong variable and names the board, so no board is dropped silently.
# Tried in a copy of the tree, with every variable of every board removed.
. "$(dirname "$0")/../checks.sh"

tree=$scratch/tree
mkdir "$tree"
cp -r Makefile mk boards "$tree"
ask() { # prints what make would say, and builds nothing
    MAKEFLAGS= make -s -C "$tree" "$@" help >"$scratch/out" 2>"$scratch/err"
}
# refused BOARD WORDS WHAT: the message names the board and has the words
refused() {
    ask
    [ $? -ne 0 ] && grep -qF "boards/$1/board.mk: $2" "$scratch/err"
    verdict $? "$3"
    cp "boards/$1/board.mk" "$tree/boards/$1/board.mk"
}

ask
verdict $? "the boards as they are"
printf 'taken: ; @echo $(BOARDS_ALL) // $(BOARDS) // $(BOARDS_TEST)\n' >>"$tree/Makefile"
LC_ALL=C
export LC_ALL
boards=$(for makefile in boards/*/board.mk; do basename "$(dirname "$makefile")"; done | sort)
taken() { # boards by BOARD_WHEN, and the one that is named
    { echo rv32imac && grep -l $1 boards/*/board.mk | cut -d / -f 2; } | sort -u | tr '\n' ' '
}
MAKEFLAGS= make -s -C "$tree" BOARD=rv32imac taken >"$scratch/out" 2>"$scratch/err"
wanted="$(echo "$boards" | tr '\n' ' ')// $(taken '-e WHEN.*test -e WHEN.*check')// $(taken '-e WHEN.*test')"
[ "$(cat "$scratch/out") " = "$wanted" ]
verdict $? "each is taken by what its BOARD_WHEN says" "$scratch/out"

for board in $boards; do
    makefile=$tree/boards/$board/board.mk
    for variable in $(sed -n 's/^\(BOARD_[A-Z]*\) *:= *[^ ].*/\1/p' "boards/$board/board.mk"); do
        case $variable in
        BOARD_MATH | BOARD_TIMING) continue ;; # these may be missing
        BOARD_SOURCES) continue ;;             # adds to the family's
        esac
        sed -i "/^$variable /d" "$makefile"
        refused "$board" "$variable is missing" "$board without $variable"
    done
    sed -i '/^include /d' "$makefile"
    refused "$board" "BOARD_DEPS is missing" "$board without a family"
    sed -i 's/^BOARD_WHEN .*/BOARD_WHEN := chek/' "$makefile"
    refused "$board" "BOARD_WHEN is 'chek': one of test check all" "$board with a misspelt BOARD_WHEN"
done
sed -i 's/^BOARD_WHEN .*/BOARD_WHEN := test check/' "$tree/boards/rv32imac/board.mk"
refused rv32imac "BOARD_WHEN is 'test check': one of" "two words"
for blank in ' ' '	' ' # why'; do
    sed -i "s/^BOARD_WHEN .*/BOARD_WHEN := check$blank/" "$tree/boards/rv32imac/board.mk"
    MAKEFLAGS= make -s -C "$tree" taken 2>"$scratch/err" | grep -q '// .*rv32imac.* //'
    verdict $? "BOARD_WHEN with '$blank' behind it counts"
done
ask BOARD=no_such
[ $? -ne 0 ] && grep -q 'There is no boards/no_such/board.mk. Boards: atmega2560 ' "$scratch/err"
verdict $? "a board that is not there"
exit $failed
