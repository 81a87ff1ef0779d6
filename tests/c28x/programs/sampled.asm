; What programs have in common whose `sample` is called at the end of each conversion: ePWM1 starts the converter every
; 50 us. They copy this file, set up what is their own and call `sampling`; `sample` ends with SAMPLED.
        .copy   "start.asm"
PERIOD  .set    5000
TBCTL   .set    0x6800
TBPRD   .set    0x6805
CMPA    .set    0x6809
ETSEL   .set    0x6819
ETPS    .set    0x681A
HISPCP  .set    0x701A
ADCTRL2 .set    0x7101
ADCMAX  .set    0x7102
ADCSEL1 .set    0x7103
ADCTRL3 .set    0x7118
ADCST   .set    0x7119

SAMPLED .macro
        MOVW    DP,#ADCTRL2>>6
        OR      @ADCTRL2,#0x4000        ; the sequencer begins anew
        MOVW    DP,#ADCST>>6
        MOV     @ADCST,#0x0010
        MOVW    DP,#PIEACK>>6
        MOV     @PIEACK,#1
        IRET
        .endm

sampling: EALLOW
        MOVW    DP,#HISPCP>>6
        MOV     @HISPCP,#4              ; 12.5 MHz for the converter
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
        MOV     @ETPS,#0x0100
        MOV     @ETSEL,#0x0900          ; SOCA at zero
        MOV     @TBCTL,#0
        EALLOW
        MOVW    DP,#PCLKCR0>>6
        OR      @PCLKCR0,#4
        EDIS
        OR      IER,#1
        CLRC    INTM
        LRETR
