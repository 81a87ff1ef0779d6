; From the flash's entry to a chip at 100 MHz: watchdog off, PLL locked, clocks of the peripherals on, the flash's waits
; and its prefetching as they are to be. Then it goes to `main`, which each program has; they copy this file.

WDCR    .set    0x7029
PLLSTS  .set    0x7011
LOSPCP  .set    0x701B
PCLKCR0 .set    0x701C
PCLKCR1 .set    0x701D
PLLCR   .set    0x7021
FOPT    .set    0x0A80
BANKW   .set    0x0A86
OTPW    .set    0x0A87
MUX2H   .set    0x6F89          ; upper half of GPAMUX2: GPIO24 to 31
PIECTRL .set    0x0CE0
PIEACK  .set    0x0CE1
PIEIER1 .set    0x0CE2
PIEIER3 .set    0x0CE6
PIEIER9 .set    0x0CF2
VECTORS .set    0x0D00
SCICCR  .set    0x7050
SCICTL1 .set    0x7051
SCIHIGH .set    0x7052
SCILOW  .set    0x7053
SCICTL2 .set    0x7054
SCIRXST .set    0x7055
SCIRX   .set    0x7057
SCITX   .set    0x7059

        .org    0x3F7FF6
        LB      start

        .org    0x3F4000
start:  SETC    OBJMODE
        SETC    INTM
        MOV     @SP,#0x0400
        SPM     0
        EALLOW
        MOVW    DP,#WDCR>>6
        MOV     @WDCR,#0x0068
        MOV     @PLLCR,#10
lock:   TBIT    @PLLSTS,#0
        B       lock,NTC
        MOV     @LOSPCP,#0
        MOV     @PCLKCR0,#0x0408        ; SCI-A, ADC
        MOV     @PCLKCR1,#0x003F        ; all ePWM
        MOVW    DP,#FOPT>>6
        MOV     @FOPT,#1
        MOV     @BANKW,#0x0303
        MOV     @OTPW,#5
        RPT     #7
     || NOP
        EDIS
        LCR     main
stay:   B       stay,UNC

; SCI-A at 115200 bit/s, eight data bits, no parity, on GPIO28 and GPIO29.
serial: EALLOW
        MOVW    DP,#MUX2H>>6
        MOV     @MUX2H,#0x0500
        EDIS
        MOVW    DP,#SCICCR>>6
        MOV     @SCICCR,#7
        MOV     @SCICTL1,#3
        MOV     @SCIHIGH,#0
        MOV     @SCILOW,#108
        MOV     @SCICTL2,#0
        MOV     @SCICTL1,#0x23
        LRETR

; AL: vector number, XAR5: routine.
vector: EALLOW
        LSL     AL,#1
        MOVL    XAR4,#VECTORS
        MOVZ    AR0,@AL
        MOVL    *+XAR4[AR0],XAR5
        EDIS
        LRETR
