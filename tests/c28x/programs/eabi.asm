; A start as the EABI's run-time has it: a table of records, each with where its data lies and where it runs; the first
; word of the data says which handler of the table of handlers unpacks the rest. Then constructors, then main. Tables and
; places are those of the test.

        .org    0x3F7FF6
        LB      _c_int00

        .org    0x3F4000
_c_int00:
        SETC    INTM,DBGM
        MOV     @AL,#0
        MOV     IER,@AL
        MOV     @SP,#0x0400
        SPM     0
        C28OBJ
        C28ADDR
        C28MAP
        CLRC    PAGE0
        MOVW    DP,#0
        CLRC    OVM
        ASP
        LCR     auto_init
        LCR     main
exit:   NOP
        SB      exit,UNC

; Records from CINIT_BASE to CINIT_LIMIT, handlers from HANDLERS on, constructors from INIT_BASE to INIT_LIMIT.
auto_init:
        PUSH    XAR1
        PUSH    XAR2
        PUSH    XAR3
        MOVL    XAR1,#CINIT_BASE
        MOVL    XAR2,#CINIT_LIMIT
        SB      more,UNC
record: MOVL    XAR4,*XAR1++
        MOVL    XAR5,*XAR1++
        MOVU    ACC,*XAR4++
        LSL     ACC,#1
        MOVL    XAR7,#HANDLERS
        ADDL    @XAR7,ACC
        MOVL    XAR7,*XAR7
        LCR     *XAR7
more:   MOVL    ACC,@XAR1
        CMPL    ACC,@XAR2
        SBF     record,NEQ
        MOVL    XAR1,#INIT_BASE
        MOVL    XAR3,#INIT_LIMIT
        SB      constructed,UNC
construct_one:  MOVL    XAR7,*XAR1++
        LCR     *XAR7
constructed:  MOVL    ACC,@XAR1
        CMPL    ACC,@XAR3
        SBF     construct_one,NEQ
        POP     XAR3
        POP     XAR2
        POP     XAR1
        LRETR

; Of each: XAR4 the data behind the handler's number, XAR5 where it runs.
zero_init:                      ; an even address, then so many words
        LCR     size
        B       zeroed,EQ
        SUBB    ACC,#1
        MOVZ    AR6,@AL
        MOV     @AL,#0
        RPT     @AR6
     || MOV     *XAR5++,AL
zeroed: LRETR

copy_none:
        LCR     size
        MOVL    XAR6,@ACC
        SB      left,UNC
each:   MOV     AL,*XAR4++
        MOV     *XAR5++,AL
        SUBB    XAR6,#1
left:   MOVL    ACC,@XAR6
        SBF     each,NEQ
        LRETR

size:   MOVL    ACC,@XAR4       ; what is aligned to 32 bits
        ADDB    ACC,#1
        AND     @AL,#0xFFFE
        MOVL    XAR4,@ACC
        MOVL    ACC,*XAR4++
        LRETR

; The mark, then words; behind the mark a length: below 4 it is the mark so often, else the next word is, and 0 ends all
; (or begins a length of 32 bits, which is more than this chip has RAM).
rle:    MOVZ    AR6,*XAR4++
word:   MOV     AL,*XAR4++
        CMP     AL,@AR6
        SBF     marked,EQ
        MOV     *XAR5++,AL
        SB      word,UNC
marked: MOVU    ACC,*XAR4++
        SBF     ended,EQ
        MOVZ    AR7,@AR6
        CMPB    AL,#4
        SB      fill,LO
        MOVZ    AR7,*XAR4++
fill:   MOV     *XAR5++,AR7
        SUBB    ACC,#1
        SBF     fill,NEQ
        SB      word,UNC
ended:  LRETR

construct:
        MOVW    DP,#BUILT>>6
        INC     @BUILT
        LRETR

main:   MOVW    DP,#DONE>>6
        MOV     @DONE,#1
        LRETR
