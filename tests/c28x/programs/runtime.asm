; Arithmetic that a C compiler calls by name where the chip has no instruction for it: under TI's names, with its way of
; giving operands, the first in ACC (AL), the second where the caller has `*-SP[2]` (AH). Floating point is IEEE's of 32
; bits, rounded to the nearest even, without infinities; what is too small becomes 0.

I$$DIV: MOVZ    AR7,@AH
        XOR     AH,@AL
        MOVZ    AR6,@AH         ; the quotient's sign
        MOV     AH,@AR7
        B       i_over,GEQ
        NEG     AH
i_over: MOVZ    AR7,@AH
        CMPB    AL,#0
        B       i_of,GEQ
        NEG     AL
i_of:   MOVU    ACC,@AL
        RPT     #15
     || SUBCU   ACC,@AR7
        TBIT    @AR6,#15
        B       i_div,NTC
        NEG     AL
i_div:  LRETR

L$$DIV: MOVL    *SP++,ACC
        MOV     AL,*-SP[1]
        XOR     AL,*-SP[5]
        MOVZ    AR7,@AL
        MOVL    ACC,*-SP[6]
        ABS     ACC
        MOVL    XAR6,@ACC
        MOVL    ACC,*--SP
        ABS     ACC
        MOVL    P,@ACC
        MOVB    ACC,#0
        RPT     #31
     || SUBCUL  ACC,@XAR6
        MOVL    ACC,@P
        TBIT    @AR7,#15
        B       l_div,NTC
        NEG     ACC
l_div:  LRETR

UL$$DIV:
        MOVL    P,@ACC
        MOVB    ACC,#0
        RPT     #31
     || SUBCUL  ACC,*-SP[4]
        MOVL    ACC,@P
        LRETR

U$$TOFS:
        MOVU    ACC,@AL
UL$$TOFS:
        MOVB    XAR6,#0
        SB      to_fs,UNC
L$$TOFS:
        MOVZ    AR6,@AH
        AND     @AR6,#0x8000
        ABS     ACC
to_fs:  CLRC    SXM
        MOV     @AR7,#158       ; the exponent of 2^31
        TEST    ACC
        B       none,EQ

; A fraction that is not 0 and its exponent, raised until the highest bit is set; then rounded, and the sign put to it.
raise:  TBIT    @AH,#15
        B       raised,TC
        LSL     ACC,#1
        DEC     @AR7
        SB      raise,UNC
raised: TBIT    @AL,#8          ; half of the last place, less where that is even
        MOVB    XAR5,#0x7F
        B       even,NTC
        ADDB    XAR5,#1
even:   ADDL    ACC,@XAR5
        B       kept,LO
        INC     @AR7            ; carried: the fraction is 0
kept:   SFR     ACC,#8
        MOVL    P,@ACC
        MOV     AL,@AR7
        CMPB    AL,#1
        B       none,LT
        LSL     AL,#7
        MOV     AH,@PH
        ANDB    AH,#0x7F
        OR      AL,@AH
        OR      AL,@AR6
        MOV     @PH,AL
        MOVL    ACC,@P
        LRETR
none:   MOVB    ACC,#0
        LRETR

FS$$SUB:
        MOVL    *SP++,ACC
        MOVL    ACC,*-SP[6]
        XOR     @AH,#0x8000
        MOVL    XAR6,@ACC
        MOVL    ACC,*--SP
        MOVL    *SP++,XAR6
        LCR     FS$$ADD
        SUBB    SP,#2
        LRETR

FS$$ADD:
        CLRC    SXM
        MOVL    *SP++,ACC
        MOVL    ACC,*-SP[6]
        MOVL    *SP++,ACC       ; the first from -SP[4], the second from -SP[2]
        AND     @AH,#0x7FFF
        MOVL    XAR6,@ACC
        MOVL    ACC,*-SP[4]
        AND     @AH,#0x7FFF
        CMPL    ACC,@XAR6
        B       larger,HIS
        MOVL    ACC,*-SP[4]     ; the first is to be the larger one
        MOVL    XAR6,*-SP[2]
        MOVL    *-SP[4],XAR6
        MOVL    *-SP[2],ACC
larger: MOV     AL,*-SP[3]
        LSR     AL,#7
        ANDB    AL,#0xFF
        MOVZ    AR7,@AL
        MOV     AH,*-SP[1]
        LSR     AH,#7
        ANDB    AH,#0xFF
        B       alone,EQ
        SUB     AL,@AH
        CMPB    AL,#31
        B       near,LOS
        MOVB    AL,#31
near:   MOV     T,@AL
        MOVL    ACC,*-SP[2]
        LSL     ACC,#7          ; room for a sum
        AND     @AH,#0x3FFF
        OR      @AH,#0x4000
        MOVL    XAR6,@ACC
        LSRL    ACC,T
        MOVL    P,@ACC
        LSLL    ACC,T
        CMPL    ACC,@XAR6
        B       whole,EQ
        OR      @PL,#1          ; something was lost
whole:  MOVL    XAR6,@P
        MOV     AL,*-SP[3]
        XOR     AL,*-SP[1]
        MOVZ    AR0,@AL
        MOVL    ACC,*-SP[4]
        LSL     ACC,#7
        AND     @AH,#0x3FFF
        OR      @AH,#0x4000
        TBIT    @AR0,#15
        B       differ,TC
        ADDL    ACC,@XAR6
        SB      signed,UNC
differ: SUBL    ACC,@XAR6
signed: MOVZ    AR6,*-SP[3]
        AND     @AR6,#0x8000
        SUBB    SP,#4
        INC     @AR7
        TEST    ACC
        B       raise,NEQ
        LRETR
alone:  MOVL    ACC,*-SP[4]
        SUBB    SP,#4
        LRETR

; For product and quotient: AR6 the sign, AR7 and AR0 the exponents, ACC and P the fractions with their highest bits.
apart:  MOV     AL,*-SP[3]
        XOR     AL,*-SP[7]
        MOVZ    AR6,@AL
        AND     @AR6,#0x8000
        MOV     AL,*-SP[3]
        LSR     AL,#7
        ANDB    AL,#0xFF
        MOVZ    AR7,@AL
        MOV     AL,*-SP[7]
        LSR     AL,#7
        ANDB    AL,#0xFF
        MOVZ    AR0,@AL
        MOVL    ACC,*-SP[8]
        LSL     ACC,#8
        OR      @AH,#0x8000
        MOVL    P,@ACC
        MOVL    ACC,*-SP[4]
        LSL     ACC,#8
        OR      @AH,#0x8000
        LRETR

FS$$MPY:
        CLRC    SXM
        MOVL    *SP++,ACC
        LCR     apart
        MOVL    *-SP[2],P
        MOVL    XT,@ACC
        MOV     AL,@AR7
        B       nought,EQ
        MOV     AL,@AR0
        B       nought,EQ
        ADD     AL,@AR7
        ADD     @AL,#-126
        MOVZ    AR7,@AL
        IMPYL   P,XT,*-SP[2]
        MOVL    XAR5,@P
        QMPYUL  P,XT,*-SP[2]
        MOVL    ACC,@XAR5
        B       exact,EQ
        OR      @PL,#1
exact:  MOVL    ACC,@P
        SUBB    SP,#2
        B       raise,UNC
nought: SUBB    SP,#2
        MOVB    ACC,#0
        LRETR

FS$$DIV:
        CLRC    SXM
        MOVL    *SP++,ACC
        LCR     apart
        SUBB    SP,#2
        SFR     ACC,#8
        MOVL    XAR4,@ACC
        MOVL    ACC,@P
        SFR     ACC,#8
        MOVL    XAR5,@ACC
        MOV     AL,@AR7
        B       none,EQ
        SUB     AL,@AR0
        ADDB    AL,#127
        MOVZ    AR7,@AL
        MOVL    ACC,@XAR4
        MPYB    P,T,#0          ; 0
        CMPL    ACC,@XAR5
        B       less,LO
        LSR64   ACC:P,#1
        SB      divide,UNC
less:   DEC     @AR7
divide: RPT     #31
     || SUBCUL  ACC,@XAR5
        TEST    ACC
        B       divided,EQ
        OR      @PL,#1
divided: MOVL   ACC,@P
        B       raise,UNC

; AL below, at or above 0, as the first is to the second.
FS$$CMP:
        LCR     ordered
        MOVL    XAR6,@ACC
        MOVL    ACC,*-SP[4]
        LCR     ordered
        CMPL    ACC,@XAR6
        B       above,LT
        B       same,EQ
        MOV     AL,#-1
        LRETR
above:  MOVB    AL,#1
        LRETR
same:   MOVB    AL,#0
        LRETR
ordered: TBIT   @AH,#15
        B       in_line,NTC
        AND     @AH,#0x7FFF
        NEG     ACC
in_line: LRETR

; Towards 0.
FS$$TOL:
        CLRC    SXM
        MOVZ    AR6,@AH
        MOVL    XAR4,@ACC
        MOV     AL,@AH
        LSR     AL,#7
        ANDB    AL,#0xFF
        ADD     @AL,#-158
        NEG     AL
        CMPB    AL,#31
        B       none,GT
        MOV     T,@AL
        MOVL    ACC,@XAR4
        LSL     ACC,#8
        OR      @AH,#0x8000
        LSRL    ACC,T
        TBIT    @AR6,#15
        B       in_line,NTC
        NEG     ACC
        LRETR
