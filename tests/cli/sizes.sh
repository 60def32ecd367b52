#!/bin/sh
# sizes.sh: mk/size/size.sh checks an image's flash and memory to the byte, and fails if main()'s stack is unknown. Images
# are made up: the output of size, nm and gcc is random.
. "$(dirname "$0")/../checks.sh"

mkdir "$scratch/objects"
echo '#!/bin/sh
cat "${0%/*}/sections"' >"$scratch/size"
echo '#!/bin/sh
cat "${0%/*}/symbols"' >"$scratch/nm"
chmod +x "$scratch/size" "$scratch/nm"
echo "LOAD $scratch/objects/main.o" >"$scratch/station.map"

# image FLASH VARIABLES FRAME: makes an image of this size, whose main() has this frame.
image() {
    printf '.vectors 100 0\n.text %d 0\n.bss %d 0\n.noinit 30 0\n.stack 5000 0\n' $(($1 - 100)) $(($2 - 30)) >"$scratch/sections"
    printf '00001000 A board_stack_limit\n00005096 A board_stack_top\n100 T board_reset\n200 T main\n300 t same.0\n300 t same.1\n' >"$scratch/symbols"
    printf 'node: { title: "board_reset" label: "board_reset\\na.c:1\\n8 bytes (static)" }
node: { title: "main" label: "main\\na.c:2\\n%d bytes (static)" }
edge: { sourcename: "board_reset" targetname: "main" label: "a.c:3" }\n' "$3" >"$scratch/objects/main.ci"
}

# sizes FLASH_MOST RAM_MOST: runs size.sh.
sizes() {
    BOARD=played CC="${CC:-cc}" FLAGS=- SIZE=$scratch/size NM=$scratch/nm OBJECTS=$scratch/objects FLASH_MOST=$1 RAM_MOST=$2 \
        MOST_OF="$scratch/station.elf" mk/size/size.sh "$scratch/sizes.csv" "$scratch/station.elf" >"$scratch/out" 2>"$scratch/err"
}

awk -v seed="${WHIRL_SEED:-1}" 'BEGIN {
    srand(seed)
    for (i = 0; i < 3; i++) { print 200 + int(60000 * rand()), 31 + int(9000 * rand()), 8 * int(400 * rand()), 1 + int(3000 * rand()) }
}' >"$scratch/drawn"
while read -r flash variables frame over; do
    image "$flash" "$variables" "$frame"
    memory=$((variables + frame + 8))
    sizes "$flash" "$memory"
    verdict $? "$flash bytes of flash and $memory of memory, of as many"
    ! sizes $((flash - over)) "$memory" && grep -q "$flash bytes of flash, $over more than" "$scratch/err" &&
        [ "$(wc -l <"$scratch/err")" -eq 1 ]
    verdict $? "$over bytes of flash too many are told"
    ! sizes "$flash" $((memory - over)) && grep -q "$memory bytes of memory, .*, $over more than" "$scratch/err" &&
        [ "$(wc -l <"$scratch/err")" -eq 1 ]
    verdict $? "$over bytes of memory too many are told"
done <"$scratch/drawn"

# If an image is optimised as a whole, its call graph is in its folder, among files with names like its members'. If
# functions are alike, only one has the figure.
image 9999 999 64
printf 'node: { title: "a.o:same.0" label: "same.0\\na.c:4\\n%d bytes (static)" }
edge: { sourcename: "main" targetname: "a.o:same.1" label: "a.c:5" }\n' 24 >>"$scratch/objects/main.ci"
sizes 9999 $((999 + 64 + 8 + 24))
verdict $? "what is alike has one figure"
mv "$scratch/objects/main.ci" "$scratch/station.elf.ltrans0.ltrans.ci"
printf 'LOAD /tmp/a.ltrans0.ltrans.o\nlib.a(main.o)\n' >"$scratch/station.map"
echo 'node: { title: "main" label: "main\na.c:2\n4000 bytes (static)" }' >"$scratch/objects/main.ci"
sizes 9999 $((999 + 64 + 8 + 24))
verdict $? "an image that is optimised as a whole has its call graph beside it"
mv "$scratch/station.elf.ltrans0.ltrans.ci" "$scratch/objects/main.ci"
echo "LOAD $scratch/objects/main.o" >"$scratch/station.map"

# The handler of an interrupt, which no function calls, is added to main(), with what the processor stacks for it and
# for a fault. Its name belongs to the whole image, or to one file if the image is optimised as a whole.
for kind in T t; do
    image 9999 999 64
    echo "400 $kind on_tick" >>"$scratch/symbols"
    echo 'node: { title: "on_tick" label: "on_tick\\na.c:6\\n40 bytes (static)" }' >>"$scratch/objects/main.ci"
    sizes 9999 $((999 + 64 + 8 + 40 + 2 * 112)) && ! sizes 9999 $((999 + 64 + 8 + 40 + 2 * 112 - 1))
    verdict $? "a handler counts ($kind)"
done

image 9999 999 64
sed '/title: "main"/d' "$scratch/objects/main.ci" >"$scratch/less" && mv "$scratch/less" "$scratch/objects/main.ci"
! sizes 99999 99999 && grep -q 'no call graph of main' "$scratch/err"
verdict $? "an image without main()'s call graph is refused"

exit $failed
