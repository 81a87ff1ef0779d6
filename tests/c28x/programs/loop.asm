; The board's side of host in the loop (firmware/hil/hil.h), as small as it can be, for a program that copies this file
; behind records.asm and deltas.asm: it speaks the record protocol, and in each step executes one control step on the
; inputs that it was brought. The program's `law` takes the difference between the first two results of all windows to
; the duty of leg a, its reverse is that of leg b; what it controls is no motor. It takes its host's word for the lengths
; in a step.
        .global EXPECT
EXPECT  .set    0x800E          ; the next step
NUMBER  .set    0x800F          ; of the step that is answered
STEPPED .set    0x8016
LINK    .set    0x8017
SUMA    .set    0x8018
SUMB    .set    0x801A
SHAPE   .set    0x801C          ; windows, words of a result, inputs, works
TOLD    .set    0x8020          ; torn, outputs
BEFORE  .set    0x8022          ; the same of the answer before
OUTPUTS .set    0x8024
EARLIER .set    0x8032          ; those of the answer before
SIGNALS .set    0x8040
INPUTS  .set    0x80C0
WORKS   .set    0x80E0
WINDOWS .set    0x8100          ; a call and six results each
END     .set    0x8200
NAME    .set    20              ; octets
TURN    .set    2500            ; ticks: a quarter of the period
WORDS   .set    14              ; of the outputs of a step

request: MOVL   XAR2,#RECORD
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

enter:  MOV     @ALONE,#0
        LCR     clear
        MOVL    XAR4,#TURN-100
        MOVL    @MOST,XAR4
        MOVL    ACC,@MOST
        NEG     ACC
        MOVL    @LEAST,ACC
        B       send,UNC

leave:  MOV     @LEAVES,#1
        B       send,UNC

clear:  MOVL    XAR4,#REF
        MOVL    XAR6,#END-REF-1
zero:   MOV     *XAR4++,#0
        BANZ    zero,AR6--
        LRETR

; ---- a step

step:   MOV     AL,@ALONE
        B       entered,EQ
        MOVB    AL,#6                   ; not in this state
        B       refuse,UNC
entered: LCR    take16
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
        MOVL    XAR4,#KNOWN
        MOVZ    AR3,*XAR4
        MOVL    XAR4,#SIGNALS
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

control: MOVB   ACC,#0
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
        SETC    SXM
        LCR     law
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

        MOVL    XAR7,#PLACES
        MOVB    ACC,#1
        LCR     tell
        MOVU    ACC,@SHAPE
        LCR     tell
        MOVU    ACC,@LINK
        LCR     tell
        MOVL    ACC,@SUMA
        LCR     tell
        MOVL    ACC,@SUMB
        LCR     tell
        MOVL    ACC,@SUM
tell:   MOVL    XAR4,#SIGNALS
        MOVZ    AR0,*XAR7++
        MOVL    *+XAR4[AR0],ACC
        LRETR
