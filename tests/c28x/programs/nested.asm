; Nested interrupts through the PIE. CPU timer 0 (INT1.7) every 25 us toggles GPIO7; ePWM1 (INT3.1) every 100 us works
; for some 70 us with GPIO6 high, and lets interrupts of group 1 in meanwhile where ALLOWED is 1.
; Words at 0x8000: timer interrupts, those of them within the other one, interrupts of the ePWM, ALLOWED.
        .copy   "start.asm"
        .global TIMERS, WITHIN, PERIODS, ALLOWED, INSIDE
TIMERS  .set    0x8000
WITHIN  .set    0x8001
PERIODS .set    0x8002
ALLOWED .set    0x8003
INSIDE  .set    0x8004
TIMPRD  .set    0x0C02
TIMTCR  .set    0x0C04
GPADIR  .set    0x6F8A
GPASET  .set    0x6FC2
GPACLR  .set    0x6FC4
GPATOG  .set    0x6FC6
TBCTL   .set    0x6800
TBPRD   .set    0x6805
ETSEL   .set    0x6819
ETPS    .set    0x681A
ETCLR   .set    0x681C

main:   MOVW    DP,#TIMERS>>6
        MOV     @TIMERS,#0
        MOV     @WITHIN,#0
        MOV     @PERIODS,#0
        MOV     @INSIDE,#0
        EALLOW
        MOVW    DP,#GPADIR>>6
        MOV     @GPADIR,#0x00C0
        EDIS
        MOV     @AL,#38                 ; INT1.7
        MOVL    XAR5,#tick
        LCR     vector
        MOV     @AL,#48                 ; INT3.1
        MOVL    XAR5,#period
        LCR     vector
        MOVW    DP,#PIECTRL>>6
        MOV     @PIEIER1,#0x40
        MOV     @PIEIER3,#0x01
        MOV     @PIECTRL,#1
        MOVW    DP,#TIMPRD>>6
        MOV     @TIMPRD,#2499
        MOV     @TIMPRD+1,#0
        MOV     @TIMTCR,#0x4020         ; interrupt on, reload, run
        MOVW    DP,#TBCTL>>6
        MOV     @TBPRD,#9999
        MOV     @ETPS,#1
        MOV     @ETSEL,#0x0009          ; at zero
        MOV     @TBCTL,#0
        EALLOW
        MOVW    DP,#PCLKCR0>>6
        OR      @PCLKCR0,#4             ; TBCLKSYNC
        EDIS
        OR      IER,#0x0005
        CLRC    INTM
sleep:  IDLE
        B       sleep,UNC

tick:   MOVW    DP,#GPATOG>>6
        MOV     @GPATOG,#0x0080
        MOVW    DP,#TIMERS>>6
        INC     @TIMERS
        MOV     AL,@INSIDE
        ADD     @WITHIN,AL
        MOVW    DP,#PIEACK>>6
        MOV     @PIEACK,#1
        IRET

period: MOVW    DP,#GPASET>>6
        MOV     @GPASET,#0x0040
        MOVW    DP,#PIEACK>>6
        MOV     @PIEACK,#4
        MOVW    DP,#PERIODS>>6
        INC     @PERIODS
        MOV     @INSIDE,#1
        TBIT    @ALLOWED,#0
        B       alone,NTC
        AND     IER,#0
        OR      IER,#0x0001
        CLRC    INTM
alone:  MOVB    XAR0,#250
        ADDB    XAR0,#125
        ADDB    XAR0,#125
        ADDB    XAR0,#125
        ADDB    XAR0,#125
        ADDB    XAR0,#125
        ADDB    XAR0,#125
work:   BANZ    work,AR0--
        SETC    INTM
        MOVW    DP,#INSIDE>>6
        MOV     @INSIDE,#0
        MOVW    DP,#ETCLR>>6
        MOV     @ETCLR,#1
        MOVW    DP,#GPACLR>>6
        MOV     @GPACLR,#0x0040
        IRET
