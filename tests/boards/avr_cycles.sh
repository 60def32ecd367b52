#!/bin/sh
# avr_cycles.sh AVR_RUN FOLDER: avr_run must count the instructions and cycles of the data sheet, and exit with the
# program's status. On chips with a program counter of three bytes, a call takes one cycle more.
set -u
run=$1
folder=$2
mkdir -p "$folder"
bad=0
while read -r mcu call; do
    avr-gcc -mmcu="$mcu" -o "$folder/cycles.elf" tests/boards/avr_cycles.S || exit 1
    status=0
    sh tests/limit.sh 60 "$run" mcu="$mcu" hz=16000000 counts="$folder/counts" "$folder/cycles.elf" || status=$?
    said=$(tr '\n' ' ' <"$folder/counts")
    wanted="interval 0 1 cycles 0 $call interval 1 2003 cycles 1 $((4001 + call)) interval 2 7 cycles 2 $((12 + call)) intervals 3 "
    if [ "$status" -eq 7 ] && [ "$said" = "$wanted" ]; then
        echo "$mcu: cycles as in the data sheet"
    else
        echo "error: $mcu: status $status, counted: $said"
        echo "    wanted: $wanted"
        bad=1
    fi
done <<END
atmega328p 4
atmega2560 5
END
exit $bad
