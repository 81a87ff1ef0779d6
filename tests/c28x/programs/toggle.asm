; ePWM1 at 50 kHz with a duty of a quarter, up-count; output A alone.
        .copy   "start.asm"
TBCTL   .set    0x6800
TBPRD   .set    0x6805
CMPA    .set    0x6809
AQCTLA  .set    0x680B
MUX1    .set    0x6F86

main:   MOVW    DP,#TBCTL>>6
        MOV     @TBPRD,#1999
        MOV     @CMPA,#500
        MOV     @AQCTLA,#0x0012         ; set at zero, clear at CMPA
        MOV     @TBCTL,#0               ; up, prescalers 1
        EALLOW
        MOVW    DP,#MUX1>>6
        MOV     @MUX1,#5                ; GPIO0 and GPIO1 are the ePWM's
        MOVW    DP,#PCLKCR0>>6
        OR      @PCLKCR0,#4             ; TBCLKSYNC
        EDIS
        LRETR
