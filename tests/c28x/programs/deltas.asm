; Words as differences from those before (firmware/hil/delta.h), for a program that copies this file behind records.asm.
LEFT    .set    0x800C
MASK    .set    0x800D

; AL words from XAR4 on are renewed from the request.
taken:  MOV     @LEFT,AL
eight:  MOV     AL,@LEFT
        B       over,EQ
        MOV     AL,*XAR2++
        MOV     @MASK,AL
        MOVB    XAR6,#7
word:   TBIT    @MASK,#0
        B       same,NTC
        LCR     unfold
        ADD     *+XAR4[0],AL
same:   ADDB    XAR4,#1
        MOV     AL,@MASK
        LSR     AL,#1
        MOV     @MASK,AL
        DEC     @LEFT
        B       over,EQ
        BANZ    word,AR6--
        B       eight,UNC
over:   LRETR

unfold: MOV     @VALUE,#0
        MOV     @T,#0
seven:  MOV     AL,*XAR2++
        MOV     AH,@AL
        ANDB    AL,#0x7F
        LSL     AL,T
        ADD     @VALUE,AL
        MOV     AL,@T
        ADDB    AL,#7
        MOV     @T,AL
        TBIT    @AH,#7
        B       seven,TC
        AND     AH,@VALUE,#1
        NEG     AH
        MOV     AL,@VALUE
        LSR     AL,#1
        XOR     AL,@AH
        LRETR

; The reverse to the answer: AL words from XAR4 on against those from XAR7 on.
given:  MOV     @LEFT,AL
group:  MOV     AL,@LEFT
        B       over,EQ
        MOVL    XAR1,@XAR5
        MOV     *XAR5++,#0
        MOV     @MASK,#1
        MOVB    XAR6,#7
each:   MOV     AL,*XAR4++
        SUB     AL,*XAR7++
        B       equal,EQ
        MOV     AH,@MASK
        OR      *+XAR1[0],AH
        LCR     fold
equal:  MOV     AL,@MASK
        LSL     AL,#1
        MOV     @MASK,AL
        DEC     @LEFT
        B       over,EQ
        BANZ    each,AR6--
        B       group,UNC

fold:   MOV     AH,@AL
        ASR     AH,#15
        LSL     AL,#1
        XOR     AL,@AH
more:   CMPB    AL,#0x7F
        B       final,LOS
        MOV     AH,@AL
        ANDB    AH,#0x7F
        ORB     AH,#0x80
        MOV     *XAR5++,AH
        LSR     AL,#7
        B       more,UNC
final:  MOV     *XAR5++,AL
        LRETR
