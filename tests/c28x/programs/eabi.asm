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
        LCR     unpack
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

unpack: MOVU    ACC,*XAR4++
        LSL     ACC,#1
        MOVL    XAR7,#HANDLERS
        ADDL    @XAR7,ACC
        MOVL    XAR7,*XAR7
        LB      *XAR7

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

; Sixteen marks, the lowest first: 1 is a word as it is, 0 a word with a distance back (12 bits, and one more) and a
; length (4 bits, and 2 more; the largest with another word to be added). The largest distance ends all.
lzss:   MOVZ    AR6,*XAR4++
        MOVB    XAR7,#15
mark:   TBIT    @AR6,#0
        SB      back,NTC
        MOV     AL,*XAR4++
        MOV     *XAR5++,AL
        SB      shifted,UNC
back:   MOV     T,*XAR4++
        MOV     AL,@T
        ANDB    AL,#15
        ADDB    AL,#1
        CMPB    AL,#16
        SBF     length,NEQ
        ADD     AL,*XAR4++
length: MOVZ    AR0,@AL
        MOV     AL,@T
        LSR     AL,#4
        CMP     @AL,#0x0FFF
        SBF     ended,EQ
        ADDB    AL,#1
        MOVZ    AR3,@AL
        MOVL    ACC,@XAR5
        SUBL    ACC,@XAR3
        MOVL    XAR3,@ACC
behind: MOV     AL,*XAR3++
        MOV     *XAR5++,AL
        BANZ    behind,AR0--
shifted: MOV    AL,@AR6
        LSR     AL,#1
        MOVZ    AR6,@AL
        BANZ    mark,AR7--
        SB      lzss,UNC

; A table of what is to be copied, in XAR4: the words of a record and how many there are, then of each where it is loaded,
; where it runs, and its words, or 0 where a handler unpacks it.
copy_in:
        PUSH    XAR1
        PUSH    XAR2
        PUSH    XAR3
        MOVL    XAR1,@XAR4
        ADDB    XAR1,#1
        MOVZ    AR2,*XAR1++
        SB      copied,UNC
copy:   MOVL    XAR4,*XAR1++
        MOVL    XAR5,*XAR1++
        MOVL    XAR6,*XAR1++
        MOVL    ACC,@XAR6
        SBF     packed,EQ
        LCR     left
        SB      copied,UNC
packed: LCR     unpack
copied: BANZ    copy,AR2--
        POP     XAR3
        POP     XAR2
        POP     XAR1
        LRETR

construct:
        MOVW    DP,#BUILT>>6
        INC     @BUILT
        LRETR

main:   MOVL    XAR4,#COPIES
        LCR     copy_in
        LCR     in_ram
        MOVW    DP,#DONE>>6
        MOV     @DONE,AL
        LRETR
