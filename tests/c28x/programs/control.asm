; A control program: ePWM1 starts the converter at each period of 50 us, the interrupt at its end takes the sample to the
; reference by an integrator, whose upper part is the duty. The serial port is served beside it: an octet is a new
; reference, 16 codes each, and answered by the last sample. With an identity among its settings it speaks the record
; protocol instead, and a host may take the converter's place and step it (loop.asm).
; Words at 0x8000: reference, last sample, duty, number of samples; the integrator at 0x8006.
        .copy   "sampled.asm"
        .copy   "records.asm"
        .copy   "deltas.asm"
        .copy   "loop.asm"
        .global REF, LAST, DUTY, COUNT, SUM
REF     .set    0x8000
LAST    .set    0x8001
DUTY    .set    0x8002
COUNT   .set    0x8003
SUM     .set    0x8006
MOST    .set    0x8010          ; of the duty
LEAST   .set    0x8012
ALONE   .set    0x8014          ; all bits set while nobody steps it, else none
AQCTLA  .set    0x680B
MUX1    .set    0x6F86
RESULT0 .set    0x0B00

main:   LCR     serial
        MOVL    XAR4,#RATE
        MOV     AL,*XAR4
        MOV     @SCICTL1,#3
        MOV     @SCILOW,AL
        MOV     @SCICTL1,#0x23
        CLRC    SXM
        MOVW    DP,#REF>>6
        LCR     clear
        MOVL    XAR4,#PERIOD-1
        MOVL    @MOST,XAR4
        MOV     @ALONE,#0xFFFF
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
        MOVW    DP,#REF>>6
        MOVL    XAR4,#IDENTITY
        MOV     AH,*XAR4
        B       heard,NEQ
        LSL     AL,#4
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
        AND     AH,@ALONE
        MOV     ACC,@AH                 ; sign-extended
        LCR     law
        AND     AL,@ALONE               ; no duty while it is stepped
        MOV     @DUTY,AL
        MOVW    DP,#CMPA>>6
        MOV     @CMPA,AL
        SAMPLED

; ACC: a difference. ACC: the duty. With SXM.
law:    ADDL    @SUM,ACC
        MOVL    ACC,@SUM
        SFR     ACC,#8
        MINL    ACC,@MOST
        MAXL    ACC,@LEAST
        LRETR

; Settings, which somebody may write over in the image: they are no part of its code.
        .global RATE, KNOWN, PLACES, IDENTITY, NAMES
        .org    0x3F6000
RATE:   .word   108             ; divider of the serial port: 115200 bit/s
KNOWN:  .word   0               ; words of all signals, but one
PLACES: .word   0,0,0,0,0,0     ; of its own signals among them
IDENTITY: .word 0               ; octets, and behind it what they are
NAMES   .set    0x3F6100        ; of all signals
