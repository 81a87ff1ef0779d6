; Background and interrupt divide by the same function, which is called as cl2000 calls it: the divisor on the stack, by
; way of XAR7. The interrupt saves what cl2000 saves, and uses all of it. It comes only when somebody asks for it.
        .copy   "start.asm"
QUOTIENT .set   0x8000                  ; two words
COUNT   .set    0x8002

main:   MOVW    DP,#QUOTIENT>>6
        MOV     @COUNT,#0
        MOV     AL,#38                  ; INT1.7
        MOVL    XAR5,#tick
        LCR     vector
        MOVW    DP,#PIECTRL>>6
        MOV     @PIEIER1,#0x40
        MOV     @PIECTRL,#1
        OR      IER,#1
        ADDB    SP,#3
        MOVL    XAR1,#0x11111
        CLRC    INTM
loop:   MOVB    ACC,#9
        MOVL    *-SP[2],ACC
        MOV     ACC,#-1000
        FFC     XAR7,divide
        MOVW    DP,#QUOTIENT>>6
        MOVL    @QUOTIENT,ACC
behind: NOP
        B       loop,UNC

divide: CLRC    OVM
        CLRC    TC
        ABSTC   ACC
        MOVL    P,ACC
        MOVL    ACC,*-SP[2]
        ABSTC   ACC
        MOVL    *-SP[2],ACC
        MOVB    ACC,#0
        RPT     #31
     || SUBCUL  ACC,*-SP[2]
        MOVL    ACC,P
        NEGTC   ACC
        FFCRET  *XAR7

tick:   ASP
        PUSH    RPC
        PUSH    AR1H:AR0H
        PUSH    XT
        PUSH    XAR4
        PUSH    XAR7
        SPM     0
        CLRC    OVM,PAGE0
        CLRC    AMODE
        ADDB    SP,#2
        MOVB    ACC,#7
        MOVL    *-SP[2],ACC
        MOVB    ACC,#100
        FFC     XAR7,divide
        MOVL    XT,ACC
        MOVL    XAR0,#0x2FFFF
        MOVL    XAR1,#0x3FFFF
        LCR     counted
        SUBB    SP,#2
        POP     XAR7
        POP     XAR4
        POP     XT
        POP     AR1H:AR0H
        POP     RPC
        NASP
        IRET

counted:
        MOVL    XAR4,#COUNT
        INC     *XAR4
        MOVW    DP,#PIEACK>>6
        MOV     @PIEACK,#1
        LRETR
