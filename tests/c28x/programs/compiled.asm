; A program in the shapes that a C compiler gives one for this chip: code entry, start, functions copied to RAM from where
; the linker has put them, the table of vectors copied from constants, masks of interrupts, an interrupt that saves what
; it calls may use, floating point by the routines of runtime.asm, variables in .ebss. Where functions lie and the table
; of vectors are the test's.

        .global _ticks, _value, _gain, _caught
_ticks  .set    0x8800
_caught .set    0x8801
_value  .set    0x8802
_gain   .set    0x8804
STACK   .set    0x0050          ; 0x200 words

        .org    0x3F7FF6
code_start:
        LB      wd_disable

        .org    0x3F4000
wd_disable:
        SETC    OBJMODE
        EALLOW
        MOVZ    DP,#0x7029>>6
        MOV     @0x29,#0x0068
        EDIS
        LB      _c_int00

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
        LCR     _main
_exit:  ESTOP0
        SB      _exit,UNC

_memcpy:                        ; XAR4 from XAR5, AL words
        MOVZ    AR6,@AL
        SB      L2,UNC
L1:     MOV     AL,*XAR5++
        MOV     *XAR4++,AL
L2:     BANZ    L1,AR6--
        LRETR

_main:  SETC    INTM,DBGM
        AND     IER,#0x0000
        AND     IFR,#0x0000
        MOVL    XAR4,#RUN
        MOVL    XAR5,#LOAD
        MOV     AL,#SIZE
        LCR     _memcpy
        EALLOW
        MOVL    XAR4,#0x0D00
        MOVL    XAR5,#_PieVectTableInit
        MOV     AL,#256
        LCR     _memcpy
        MOVW    DP,#0x0CE0>>6
        OR      @0x20,#0x0001   ; PIECTRL: ENPIE
        OR      @0x22,#0x0040   ; PIEIER1: INTx7
        EDIS
        MOVW    DP,#_ticks>>6
        MOV     @_ticks,#0
        MOV     @_caught,#0
        MOV     AL,#0
        MOV     AH,#0x3F80
        MOVL    @_value,ACC     ; 1.0
        MOV     AL,#0xCCCD
        MOV     AH,#0x3F8C
        MOVL    @_gain,ACC      ; 1.1
        LCR     _InitCpuTimer
        OR      IER,#0x0001
        OR      IER,#0x0002
        CLRC    INTM
        CLRC    DBGM
        OR      IFR,#0x0002     ; by hand, which the PIE has no flag for
        RPT     #7
     || NOP
        AND     IER,#0xFFFD
        TRAP    #20             ; USER1
L3:     MOVW    DP,#_ticks>>6
        MOV     AL,@_ticks
        MOV     AH,#7
        LCR     I$$DIV
        B       L3,UNC

_user_isr:
        ASP
        PUSH    AR1H:AR0H
        CLRC    PAGE0,OVM
        CLRC    AMODE
        MOVW    DP,#_caught>>6
        INC     @_caught
        POP     AR1H:AR0H
        NASP
        IRET

_cpu_timer0_isr:
        ASP
        PUSH    AR1H:AR0H
        MOVL    *SP++,XAR4
        MOVL    *SP++,XAR5
        MOVL    *SP++,XAR6
        MOVL    *SP++,XAR7
        MOVL    *SP++,XT
        ADDB    SP,#2
        SPM     0
        CLRC    PAGE0,OVM
        CLRC    AMODE
        MOVW    DP,#_ticks>>6
        INC     @_ticks
        MOVL    ACC,@_gain
        MOVL    *-SP[2],ACC
        MOVL    ACC,@_value
        LCR     FS$$MPY
        MOVW    DP,#_value>>6
        MOVL    @_value,ACC
        MOVW    DP,#0x0CE0>>6
        MOV     @0x21,#1        ; PIEACK
        SUBB    SP,#2
        MOVL    XT,*--SP
        MOVL    XAR7,*--SP
        MOVL    XAR6,*--SP
        MOVL    XAR5,*--SP
        MOVL    XAR4,*--SP
        POP     AR1H:AR0H
        NASP
        IRET

_rsvd_ISR:
        ESTOP0
        SB      _rsvd_ISR,UNC

        .copy   "runtime.asm"
