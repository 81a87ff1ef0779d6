; A control program: ePWM1 starts the converter at each period of 50 us, the interrupt at its end takes the sample to the
; reference by an integrator, whose upper part is the duty. The serial port is served beside it: an octet is a new
; reference, 16 codes each, and answered by the last sample.
; Words at 0x8000: reference, last sample, duty, number of samples; the integrator at 0x8006.
        .copy   "start.asm"
        .global REF, LAST, DUTY, COUNT, SUM
REF     .set    0x8000
LAST    .set    0x8001
DUTY    .set    0x8002
COUNT   .set    0x8003
SUM     .set    0x8006
PERIOD  .set    5000
TBCTL   .set    0x6800
TBPRD   .set    0x6805
CMPA    .set    0x6809
AQCTLA  .set    0x680B
ETSEL   .set    0x6819
ETPS    .set    0x681A
MUX1    .set    0x6F86
HISPCP  .set    0x701A
ADCTRL2 .set    0x7101
ADCMAX  .set    0x7102
ADCSEL1 .set    0x7103
ADCTRL3 .set    0x7118
ADCST   .set    0x7119
RESULT0 .set    0x0B00

main:   MOVW    DP,#REF>>6
        MOV     @REF,#0
        MOV     @LAST,#0
        MOV     @DUTY,#0
        MOV     @COUNT,#0
        MOVB    ACC,#0
        MOVL    @SUM,ACC
        LCR     serial
        EALLOW
        MOVW    DP,#HISPCP>>6
        MOV     @HISPCP,#4              ; 12.5 MHz for the converter
        MOVW    DP,#MUX1>>6
        MOV     @MUX1,#5
        EDIS
        MOVW    DP,#ADCTRL3>>6
        MOV     @ADCTRL3,#0x00E0        ; reference, band gap and converter on
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
        MOV     @TBPRD,#PERIOD-1
        MOV     @CMPA,#0
        MOV     @AQCTLA,#0x0012         ; set at zero, clear at CMPA
        MOV     @ETPS,#0x0100
        MOV     @ETSEL,#0x0900          ; SOCA at zero
        MOV     @TBCTL,#0
        EALLOW
        MOVW    DP,#PCLKCR0>>6
        OR      @PCLKCR0,#4
        EDIS
        OR      IER,#1
        CLRC    INTM

beside: MOVW    DP,#SCIRXST>>6
        TBIT    @SCIRXST,#6
        B       beside,NTC
        MOV     AL,@SCIRX
        ANDB    AL,#0xFF
        LSL     AL,#4
        MOVW    DP,#REF>>6
        MOV     @REF,AL
        MOV     AL,@LAST
        LSR     AL,#4
        MOVW    DP,#SCITX>>6
        MOV     @SCITX,AL
        B       beside,UNC

sample: SETC    SXM
        MOVW    DP,#RESULT0>>6
        MOV     AL,@RESULT0
        MOVW    DP,#REF>>6
        INC     @COUNT
        MOV     @LAST,AL
        MOV     AH,@REF
        SUB     AH,@LAST
        MOV     ACC,@AH                 ; sign-extended
        ADDL    @SUM,ACC
        MOVL    ACC,@SUM
        SFR     ACC,#8
        MOV     @T,#PERIOD-1
        MIN     AL,@T
        MOV     @DUTY,#0
        MAX     AL,@DUTY
        MOV     @DUTY,AL
        MOVW    DP,#CMPA>>6
        MOV     @CMPA,AL
        MOVW    DP,#ADCTRL2>>6
        OR      @ADCTRL2,#0x4000        ; the sequencer begins anew
        MOVW    DP,#ADCST>>6
        MOV     @ADCST,#0x0010
        MOVW    DP,#PIEACK>>6
        MOV     @PIEACK,#1
        IRET
