; A counter that the background raises and a timer interrupt as well: `torn` in three steps, `whole` in one. CPU timer 0
; is set up and stands, so that the interrupt comes only when somebody asks for it. The interrupt of `careless` uses
; XAR7 and does not put it back.
        .copy   "start.asm"
        .global COUNT
COUNT   .set    0x8000

main:   MOVW    DP,#COUNT>>6
        MOV     @COUNT,#0
        MOV     @AL,#38                 ; INT1.7
        MOVL    XAR5,#tick
        LCR     vector
        MOVW    DP,#PIECTRL>>6
        MOV     @PIEIER1,#0x40
        MOV     @PIECTRL,#1
        OR      IER,#1
        CLRC    INTM
        MOVL    XAR7,#0x12345

torn:   MOVW    DP,#COUNT>>6
        MOV     AL,@COUNT
        ADDB    AL,#1
        MOV     @COUNT,AL
whole:  MOVW    DP,#COUNT>>6
        INC     @COUNT
guard:  SETC    INTM
        MOV     AL,@COUNT
        ADDB    AL,#1
        MOV     @COUNT,AL
        CLRC    INTM
        NOP
again:  B       torn,UNC

tick:   MOVW    DP,#COUNT>>6
        INC     @COUNT
        MOVW    DP,#PIEACK>>6
        MOV     @PIEACK,#1
        IRET

careless:
        MOVL    XAR7,#COUNT
        INC     *XAR7
        MOVW    DP,#PIEACK>>6
        MOV     @PIEACK,#1
        IRET
