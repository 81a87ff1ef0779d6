; The board's side of host in the loop (firmware/hil/hil.h), as small as it can be: it speaks the record protocol at the
; rate of a board in the loop, and in each step executes one control step on the inputs that it was brought. What it
; controls is no motor: the integral of the difference between the first two results of all windows is the duty of leg
; a, its reverse that of leg b. It takes its host's word for the lengths in a step. Whoever assembles it says in
; identity.asm what it calls itself, where its signals have their places and what they are called.
        .copy   "start.asm"
        .copy   "identity.asm"
        .copy   "records.asm"
        .copy   "deltas.asm"
        .global EXPECT, INTEGRL
EXPECT  .set    0x8006          ; the next step
NUMBER  .set    0x8007          ; of the step that is answered
MOST    .set    0x8008
LEAST   .set    0x800A
; From here on everything is zero when the loop is entered.
ZEROS   .set    0x8010
STEPPED .set    0x8010
LINK    .set    0x8011
SUMA    .set    0x8012
SUMB    .set    0x8014
INTEGRL .set    0x8016
SHAPE   .set    0x8018          ; windows, words of a result, inputs, works
TOLD    .set    0x801C          ; torn, outputs
BEFORE  .set    0x801E          ; the same of the answer before
OUTPUTS .set    0x8020
EARLIER .set    0x8030          ; those of the answer before
SIGNALS .set    0x8040
INPUTS  .set    0x80C0
WORKS   .set    0x80E0
WINDOWS .set    0x8100          ; a call and six results each
END     .set    0x8200
TURN    .set    2500            ; ticks: a quarter of the period
WORDS   .set    14              ; of the outputs of a step

main:   LCR     serial
        MOV     @SCICTL1,#3
        MOV     @SCILOW,#31             ; 390625 bit/s
        MOV     @SCICTL1,#0x23
        CLRC    SXM
        MOVW    DP,#BUFFER>>6
        MOV     @BUFFER,#0
        MOV     @EXPECT,#0
        MOV     @LEAVES,#0
        MOVL    XAR4,#TURN-100
        MOVL    @MOST,XAR4
        MOVL    ACC,@MOST
        NEG     ACC
        MOVL    @LEAST,ACC
        LCR     clear
        B       heard,UNC

request:
        MOVL    XAR2,#RECORD
        MOVL    XAR5,#ANSWER
        MOV     AL,*XAR2++
        MOV     AH,@AL
        ORB     AH,#0x80
        MOV     *XAR5++,AH
        MOV     AH,*XAR2++              ; tag
        MOV     *XAR5++,AH
        MOV     *XAR5++,#0
        CMPB    AL,#0x01
        B       who,EQ
        CMPB    AL,#0x03
        B       named,EQ
        CMPB    AL,#0x06
        B       kept,EQ
        CMPB    AL,#0x07
        B       send,EQ
        CMPB    AL,#0x09
        B       look,EQ
        CMPB    AL,#0x20
        B       enter,EQ
        CMPB    AL,#0x21
        B       step,EQ
        CMPB    AL,#0x22
        B       leave,EQ
        MOVB    AL,#1                   ; there is no such request
refuse: MOVL    XAR4,#ANSWER
        MOV     *+XAR4[2],AL
        B       send,UNC

; ---- requests

who:    MOVL    XAR4,#IDENTITY
        MOVZ    AR3,*XAR4++
        LCR     pass
        B       send,UNC

named:  LCR     take16
        MOV     @T,#NAME
        MPYU    ACC,T,@AL
        MOVL    XAR4,#NAMES
        ADDL    @XAR4,ACC
        MOV     *XAR5++,#0              ; no fraction bits, needs nothing
        MOVB    XAR3,#NAME
        LCR     pass
        B       send,UNC

kept:   MOVL    XAR4,#RECORD+4
        MOVB    XAR3,#4
        LCR     pass
        B       send,UNC

look:   MOV     AL,@LENGTH
        LSR     AL,#1
        ADDB    AL,#-1
        MOVZ    AR6,@AL
        B       looked,UNC
seen:   LCR     take16
        LSL     AL,#1
        MOVZ    AR0,@AL
        MOVL    XAR4,#SIGNALS
        MOVL    ACC,*+XAR4[AR0]
        LCR     put32
looked: BANZ    seen,AR6--
        MOV     *XAR5++,#0              ; what is known
        B       send,UNC

enter:  MOV     @EXPECT,#0
        LCR     clear
        B       send,UNC

leave:  MOV     @LEAVES,#1
        B       send,UNC

clear:  MOVL    XAR4,#ZEROS
        MOVL    XAR6,#END-ZEROS-1
zero:   MOV     *XAR4++,#0
        BANZ    zero,AR6--
        LRETR

; ---- a step

step:   LCR     take16
        MOV     @NUMBER,AL
        SUB     AL,@EXPECT
        B       new,EQ
        ADDB    AL,#1
        B       wrong,NEQ
        MOV     AL,@STEPPED
        B       reply,NEQ               ; asked for again, and not carried out again
wrong:  MOV     AL,@EXPECT
        LCR     put16
        MOVB    AL,#7
        B       refuse,UNC

new:    MOVL    XAR4,#OUTPUTS
        MOVL    XAR6,#EARLIER
        MOVL    ACC,@TOLD
        MOVL    @BEFORE,ACC
        MOVB    XAR3,#WORDS-1
keep:   MOV     AL,*XAR4++
        MOV     *XAR6++,AL
        BANZ    keep,AR3--
        MOVL    XAR4,#SHAPE
        MOVB    AL,#4
        LCR     taken
        MOVL    XAR4,#WORKS
        MOV     AL,@SHAPE+3
        LCR     taken
        MOVL    XAR4,#INPUTS
        MOV     AL,@SHAPE+2
        LCR     taken
        MOVL    XAR7,#WINDOWS
        MOVZ    AR3,@SHAPE
        B       opened,UNC
window: MOVL    XAR4,@XAR7
        MOV     AL,@SHAPE+1
        ADDB    AL,#1
        LCR     taken
        ADDB    XAR7,#7
opened: BANZ    window,AR3--
        LCR     control
        MOV     @STEPPED,#1
        INC     @EXPECT

reply:  MOV     AL,@NUMBER
        LCR     put16
        MOVL    XAR4,#TOLD
        MOVL    XAR7,#BEFORE
        MOVB    AL,#2
        LCR     given
        MOVL    XAR4,#OUTPUTS
        MOVL    XAR7,#EARLIER
        MOV     AL,@TOLD+1
        LCR     given
        MOVL    XAR4,#SIGNALS
        MOVB    XAR3,#2*COUNT-1
        LCR     crc32
        LCR     put32
        B       send,UNC

; AR3: words but one, XAR4: the first. ACC: CRC-32, the lower octet of each word first
crc32:  MOVB    ACC,#0
        NOT     ACC
half:   XOR     AL,*XAR4++
        MOVB    XAR6,#15
bit32:  SFR     ACC,#1
        B       even32,LO
        XOR     @AL,#0x8320
        XOR     @AH,#0xEDB8
even32: BANZ    bit32,AR6--
        BANZ    half,AR3--
        NOT     ACC
        LRETR

; ---- the control step, and what it tells the hardware: the frame of the next period

control:
        MOVB    ACC,#0
        MOVL    @SUMA,ACC
        MOVL    @SUMB,ACC
        MOVL    XAR4,#WINDOWS
        MOVZ    AR3,@SHAPE
        B       summed,UNC
adds:   MOVU    ACC,*+XAR4[1]
        ADDL    @SUMA,ACC
        MOVU    ACC,*+XAR4[2]
        ADDL    @SUMB,ACC
        MOV     AL,*+XAR4[3]
        MOV     @LINK,AL
        ADDB    XAR4,#7
summed: BANZ    adds,AR3--
        MOVL    ACC,@SUMA
        SUBL    ACC,@SUMB
        ADDL    @INTEGRL,ACC

        MOVL    XAR4,#SIGNALS
        MOVB    ACC,#1
        MOVB    XAR0,#2*AT_STATE
        MOVL    *+XAR4[AR0],ACC
        MOVU    ACC,@SHAPE
        MOVB    XAR0,#2*AT_WINDOWS
        MOVL    *+XAR4[AR0],ACC
        MOVU    ACC,@LINK
        MOVB    XAR0,#2*AT_LINK
        MOVL    *+XAR4[AR0],ACC
        MOVL    ACC,@SUMA
        MOVB    XAR0,#2*AT_A
        MOVL    *+XAR4[AR0],ACC
        MOVL    ACC,@SUMB
        MOVB    XAR0,#2*AT_B
        MOVL    *+XAR4[AR0],ACC
        MOVL    ACC,@INTEGRL
        MOVB    XAR0,#2*AT_INTEGRAL
        MOVL    *+XAR4[AR0],ACC

        SETC    SXM
        SFR     ACC,#8
        MINL    ACC,@MOST
        MAXL    ACC,@LEAST
        CLRC    SXM
        MOV     @T,AL
        MOV     @TOLD,#0
        MOV     @TOLD+1,#WORDS
        MOVL    XAR4,#OUTPUTS
        MOV     *XAR4++,#1              ; a frame: on and off of each leg
        MOV     AH,#TURN
        SUB     AH,@T
        MOV     *XAR4++,AH
        MOV     AH,#3*TURN
        ADD     AH,@T
        MOV     *XAR4++,AH
        MOV     AH,#TURN
        ADD     AH,@T
        MOV     *XAR4++,AH
        MOV     AH,#3*TURN
        SUB     AH,@T
        MOV     *XAR4++,AH
        MOV     *XAR4++,#TURN
        MOV     *XAR4++,#3*TURN
        MOVB    XAR3,#5
        MOV     AH,#0xFFFF
bursts: MOV     *XAR4++,AH              ; none
        BANZ    bursts,AR3--
        MOV     *XAR4++,#4*TURN-1       ; deadline
        LRETR
