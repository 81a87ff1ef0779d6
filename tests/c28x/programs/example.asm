; A program that starts as cl2000's run-time and TI's header files for this chip let one start: code entry, watchdog off,
; the table of initial values (near and far), constructors, registers by their functions (clock, PIE, GPIO, converter,
; code security), functions copied to RAM that run there, a timer's interrupt, the main loop that feeds the watchdog.
; Words in M1, where cl2000's examples have the stack as well; results from 0x9000.

        .global TICKS, CLOCK, SECURE, SUM, FAR, BUILT, SAMPLE, FED
TICKS   .set    0x9000
CLOCK   .set    0x9001
SECURE  .set    0x9002
SUM     .set    0x9003
FAR     .set    0x9004          ; two words
BUILT   .set    0x9006
SAMPLE  .set    0x9007
FED     .set    0x9008
INITS   .set    0x9009          ; three words
STACK   .set    0x0400
RAMRUN  .set    0x8000
RAMLOAD .set    0x3F6000

        .org    0x3F7FF6
codestart:
        LB      wd_disable

        .org    0x3F4000
wd_disable:
        SETC    OBJMODE
        EALLOW
        MOVZ    DP,#0x7029>>6
        MOV     @0x29,#0x0068
        EDIS
        LB      _c_int00

; The C run-time's entry.
_c_int00:
        MOV     @SP,#STACK
        SPM     0
        SETC    OBJMODE
        CLRC    AMODE
        SETC    M0M1MAP
        CLRC    PAGE0
        MOVW    DP,#0
        CLRC    OVM
        ASP

; Initial values: words, address, data; a negative count has an address of 32 bits; 0 ends.
        MOVL    XAR7,#cinit
record: PREAD   AL,*XAR7
        ADDB    XAR7,#1
        CMPB    AL,#0
        B       pinits,EQ
        B       near,GT
        NEG     AL
        MOVZ    AR0,@AL
        PREAD   AR6,*XAR7       ; low, then high
        ADDB    XAR7,#1
        PREAD   AL,*XAR7
        ADDB    XAR7,#1
        MOV     AH,@AL
        MOV     AL,@AR6
        MOVL    XAR6,ACC
        B       copy,UNC
near:   MOVZ    AR0,@AL
        PREAD   AL,*XAR7
        ADDB    XAR7,#1
        MOVZ    AR6,@AL
copy:   SUBB    XAR0,#1
        RPT     @AR0
     || PREAD   *XAR6++,*XAR7
        ADDB    XAR0,#1
        MOVU    ACC,@AR0
        ADDL    ACC,@XAR7
        MOVL    XAR7,@ACC
        B       record,UNC

; Constructors: addresses of functions; 0 ends.
pinits: MOVL    XAR1,#pinit
next:   MOVL    ACC,*XAR1++
        B       ready,EQ
        MOVL    XAR7,ACC
        LCR     *XAR7
        B       next,UNC
ready:  LCR     _main
        LB      $

_construct:
        MOVW    DP,#BUILT>>6
        INC     @BUILT
        LRETR

_InitPll:
        MOVW    DP,#0x7011>>6
        TBIT    @0x11,#3        ; MCLKSTS: a missing clock would stop here
        B       clocked,NTC
        ESTOP0
clocked: EALLOW
        OR      @0x11,#0x0040   ; MCLKOFF while the PLL settles
        MOV     @0x21,#10
        EDIS
        EALLOW
        MOV     @0x29,#0x0068
        EDIS
locked: TBIT    @0x11,#0
        B       locked,NTC
        EALLOW
        AND     @0x11,#0xFFBF
        EDIS
        LRETR

_CsmUnlock:
        MOVL    XAR4,#0x3F7FF8  ; passwords: read, then given as keys, then read again
        MOVB    XAR0,#7
look:   MOV     AL,*XAR4++
        BANZ    look,AR0--
        EALLOW
        MOVL    XAR5,#0x0AE0
        MOVB    XAR0,#7
key:    MOV     *XAR5++,#0xFFFF
        BANZ    key,AR0--
        EDIS
        MOVL    XAR4,#0x3F7FF8
        MOVB    XAR0,#7
again:  MOV     AL,*XAR4++
        BANZ    again,AR0--
        MOVL    XAR5,#0x0AEF
        MOV     AL,*XAR5
        ANDB    AL,#1
        MOVW    DP,#SECURE>>6
        MOV     @SECURE,AL
        LRETR

_MemCopy:                       ; XAR4 from, XAR6 to its end, XAR5 to
        B       whole,UNC
word:   MOV     AL,*XAR4++
        MOV     *XAR5++,AL
whole:  MOVL    ACC,@XAR4
        CMPL    ACC,@XAR6
        B       word,LO
        LRETR

_InitPie:
        MOVW    DP,#0x0CE0>>6
        MOV     @0x20,#0        ; ENPIE off
        MOVL    XAR4,#0x0D00    ; all vectors are the one that stops, then the timer's
        MOVL    XAR5,#_stop
        MOVB    XAR0,#127
        EALLOW
vectors: MOVL   *XAR4++,XAR5
        BANZ    vectors,AR0--
        MOVL    XAR4,#0x0D4C    ; TINT0, INT1.7
        MOVL    XAR5,#_tick
        MOVL    *XAR4,XAR5
        EDIS
        MOV     @0x20,#1
        MOV     @0x22,#0x0040
        LRETR

_InitAdc:
        EALLOW
        MOVW    DP,#0x701C>>6
        MOV     @0x1A,#5
        OR      @0x1C,#0x0008
        EDIS
        MOVW    DP,#0x7100>>6
        MOV     @0x00,#0x4000   ; reset, then band gap, reference and the rest on, and 5 ms
        NOP
        NOP
        MOV     @0x18,#0x00E0
        MOVL    XAR4,#99998 ; of 5 cycles
        MOVL    ACC,@XAR4
delay:  LCR     _DSP28x_usDelay
delayed: MOV    @0x03,#15       ; ADCINB7, 1.5 V of 3
        MOV     @0x01,#0x2000   ; sequencer 1 by software
        RPT     #60
     || NOP
done:   TBIT    @0x19,#0
        B       done,NTC
        MOV     @0x19,#0x0010
        MOVW    DP,#0x7108>>6
        MOV     AL,@0x08
        MOVW    DP,#SAMPLE>>6
        MOV     @SAMPLE,AL
        LRETR

_StartTimer:
        MOVW    DP,#0x0C00>>6
        MOV     @0x04,#0x4010   ; stopped
        MOV     @0x02,#9999     ; 100 us
        MOV     @0x03,#0
        MOV     @0x06,#0
        MOV     @0x07,#0
        MOV     @0x04,#0x4020   ; reload
        MOV     @0x04,#0x4000   ; with its interrupt
        LRETR

_main:  ADDB    SP,#2
        EALLOW
        MOVW    DP,#0x7029>>6
        MOV     @0x29,#0x0068
        EDIS
        LCR     _InitPll
        DINT
        AND     IER,#0
        AND     IFR,#0
        MOVL    XAR4,#RAMLOAD
        MOVL    XAR6,#RAMLOAD+FLASHED
        MOVL    XAR5,#RAMRUN
        LCR     _MemCopy
        LCR     RAMRUN          ; InitFlash
        LCR     _CsmUnlock
        LCR     _InitPie
        LCR     _InitAdc
        LCR     _StartTimer
        MOVL    XAR4,#INITS
        MOV     AL,*XAR4++
        ADD     AL,*XAR4++
        ADD     AL,*XAR4++
        MOVW    DP,#SUM>>6
        MOV     @SUM,AL
        EALLOW
        MOVW    DP,#0x7029>>6
        MOV     @0x29,#0x0028   ; the watchdog runs again
        EDIS
        OR      IER,#1
        EINT
        CLRC    DBGM
forever: EALLOW
        MOVW    DP,#0x7025>>6
        MOV     @0x25,#0x0055
        MOV     @0x25,#0x00AA
        EDIS
        MOVW    DP,#FED>>6
        MOV     @FED,#1
        B       forever,UNC

_tick:  ASP
        MOVW    DP,#TICKS>>6
        INC     @TICKS
        MOVW    DP,#0x0CE1>>6
        MOV     @0x21,#1
        NASP
        IRET

_stop:  ESTOP0
        B       _stop,UNC

        .org    0x3F5000
pinit:  .long   _construct, _construct, 0
cinit:  .word   3, INITS, 11, 22, 33
        .word   -2, FAR&0xFFFF, FAR>>16, 0x5678, 0x1234
        .word   3, TICKS, 0, 100, 0xAAAA
        .word   0
