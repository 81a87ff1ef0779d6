; What example.asm copies to RAM: the flash's waits, which code in the flash must not set, and a delay of cl2000's examples.
        .org    0x8000
_InitFlash:
        EALLOW
        MOVW    DP,#0x0A80>>6
        MOV     @0x00,#1        ; FOPT: pipeline on
        MOV     @0x03,#0x0100   ; FSTDBYWAIT, FACTIVEWAIT
        MOV     @0x04,#0x0100
        MOV     @0x06,#0x0303
        MOV     @0x07,#5
        EDIS
        RPT     #7
     || NOP
        LRETR

_DSP28x_usDelay:
        SUB     ACC,#1
        BF      _DSP28x_usDelay,GEQ
        LRETR
