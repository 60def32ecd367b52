; avr_cycles.S: what boards/avr/run/avr_run.c counts, in intervals whose instructions and cycles the data sheet gives
; (Microchip, AVR Instruction Set Manual): avr_cycles.sh knows them.
        .global wh_count_begin, wh_count_end, main
wh_count_begin:
        ret
wh_count_end:
        ret
main:
        call wh_count_begin
        call wh_count_end

        call wh_count_begin
        ldi r24, lo8(1000)
        ldi r25, hi8(1000)
1:      sbiw r24, 1
        brne 1b
        call wh_count_end

        call wh_count_begin
        mul r24, r25
        push r0
        pop r0
        lds r24, 0x0100
        sts 0x0100, r24
        rjmp 2f
2:      call wh_count_end

        ldi r24, 7              ; the exit status, in GPIOR0
        out 0x1e, r24
        cli
        sleep
