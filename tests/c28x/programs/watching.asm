; A program whose compare values are what it is told from outside: every 50 us it writes the position of the encoder, 4096
; more with the run switch closed, to CMPA, and whether the trip of the emergency switch has come to CMPB.
        .copy   "sampled.asm"
CMPB    .set    0x680A
TZSEL   .set    0x6812
TZFLG   .set    0x6816
QPOSCNT .set    0x6B00
QPOSMAX .set    0x6B04
QEPCTL  .set    0x6B15
MUX1H   .set    0x6F87
MUX2    .set    0x6F88
PINS16  .set    0x6FC1

main:   EALLOW
        MOVW    DP,#PCLKCR1>>6
        MOV     @PCLKCR1,#0x403F        ; the encoder's module, too
        MOVW    DP,#MUX1H>>6
        MOV     @MUX1H,#0x0400          ; GPIO13 is TZ2
        MOV     @MUX2,#0x0500           ; GPIO20 and 21 are the encoder's
        MOVW    DP,#TZSEL>>6
        MOV     @TZSEL,#0x0200          ; TZ2 trips until somebody clears it
        EDIS
        MOVW    DP,#QPOSMAX>>6
        MOV     @QPOSMAX,#0xFFFF
        MOV     @QPOSMAX+1,#0xFFFF
        MOV     @QEPCTL,#0x1008         ; counts, and wraps at the maximum
        LCR     sampling
rest:   B       rest,UNC

sample: MOVW    DP,#QPOSCNT>>6
        MOVL    ACC,@QPOSCNT
        MOVW    DP,#PINS16>>6
        TBIT    @PINS16,#9              ; GPIO25, low when closed
        B       open,TC
        ADD     AL,#4096
open:   MOVW    DP,#CMPA>>6
        MOV     @CMPA,AL
        MOV     AH,@TZFLG
        MOV     @CMPB,AH
        SAMPLED
