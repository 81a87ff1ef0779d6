; A program whose compare values are what it is told from outside: every 50 us it writes the position of the encoder, 4096
; more with the run switch closed, to CMPA, and whether the trip of the emergency switch has come to CMPB.
        .copy   "start.asm"
TBCTL   .set    0x6800
TBPRD   .set    0x6805
CMPA    .set    0x6809
CMPB    .set    0x680A
TZSEL   .set    0x6812
TZFLG   .set    0x6816
ETSEL   .set    0x6819
ETPS    .set    0x681A
QPOSCNT .set    0x6B00
QPOSMAX .set    0x6B04
QEPCTL  .set    0x6B15
MUX1H   .set    0x6F87
MUX2    .set    0x6F88
PINS16  .set    0x6FC1
HISPCP  .set    0x701A
ADCTRL2 .set    0x7101
ADCMAX  .set    0x7102
ADCSEL1 .set    0x7103
ADCTRL3 .set    0x7118
ADCST   .set    0x7119

main:   EALLOW
        MOVW    DP,#HISPCP>>6
        MOV     @HISPCP,#4              ; 12.5 MHz for the converter
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
        MOVW    DP,#ADCTRL3>>6
        MOV     @ADCTRL3,#0x00E0
        MOV     @ADCMAX,#0
        MOV     @ADCSEL1,#0
        MOV     @ADCTRL2,#0x0900        ; started by SOCA, interrupt at the end
        MOVL    XAR6,#60000             ; 5 ms and more until it may convert
warm:   SUBB    XAR6,#1
        MOVL    ACC,@XAR6
        B       warm,NEQ
        MOV     @AL,#32                 ; INT1.1
        MOVL    XAR5,#sample
        LCR     vector
        MOVW    DP,#PIECTRL>>6
        MOV     @PIEIER1,#1
        MOV     @PIECTRL,#1
        MOVW    DP,#TBCTL>>6
        MOV     @TBPRD,#4999
        MOV     @ETPS,#0x0100
        MOV     @ETSEL,#0x0900          ; SOCA at zero
        MOV     @TBCTL,#0
        EALLOW
        MOVW    DP,#PCLKCR0>>6
        OR      @PCLKCR0,#4
        EDIS
        OR      IER,#1
        CLRC    INTM
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
        MOVW    DP,#ADCTRL2>>6
        OR      @ADCTRL2,#0x4000        ; the sequencer begins anew
        MOVW    DP,#ADCST>>6
        MOV     @ADCST,#0x0010
        MOVW    DP,#PIEACK>>6
        MOV     @PIEACK,#1
        IRET
