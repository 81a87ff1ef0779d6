; A control program: ePWM1 starts the converter at each period of 50 us, the interrupt at its end takes the sample to the
; reference by an integrator, whose upper part is the duty. The serial port is served beside it: an octet is a new
; reference, 16 codes each, and answered by the last sample.
; Words at 0x8000: reference, last sample, duty, number of samples; the integrator at 0x8006.
        .copy   "sampled.asm"
        .global REF, LAST, DUTY, COUNT, SUM
REF     .set    0x8000
LAST    .set    0x8001
DUTY    .set    0x8002
COUNT   .set    0x8003
SUM     .set    0x8006
AQCTLA  .set    0x680B
MUX1    .set    0x6F86
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
        MOVW    DP,#MUX1>>6
        MOV     @MUX1,#5
        EDIS
        MOVW    DP,#CMPA>>6
        MOV     @CMPA,#0
        MOV     @AQCTLA,#0x0012         ; set at zero, clear at CMPA
        LCR     sampling

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
        SAMPLED
