; Records (firmware/link/record.h) over the serial port, for a program that copies this file behind its own registers'
; names: it goes to `heard` with an octet in AL, which goes on to `request` with a record's octets at RECORD and their
; number in LENGTH when there is a whole one, and else back to `beside`; `send` sends the octets from ANSWER up to XAR5
; and goes to `beside`. An answer is shorter than 254 octets. DP is that of BUFFER, 0x8000 to 0x803F.
BUFFER  .set    0x8008          ; octets of the record that is being received
LEAVES  .set    0x8009          ; not zero: the answer is the last one, the watchdog's reset comes behind it
LENGTH  .set    0x800A          ; of a record without its check sum
VALUE   .set    0x800B
RAW     .set    0x8200          ; received, as it comes
RECORD  .set    0x8300
ANSWER  .set    0x8400

heard:  MOVL    XAR1,#RAW
        MOVZ    AR0,@BUFFER
        CMPB    AL,#0
        B       mark,EQ
        MOV     *+XAR1[AR0],AL
        MOV     AL,@BUFFER
        ADDB    AL,#1
        ANDB    AL,#0xFF                ; what is longer is no record
        MOV     @BUFFER,AL
        B       beside,UNC

mark:   MOVZ    AR3,@BUFFER
        MOV     @BUFFER,#0
        MOV     AL,@AR3
        B       beside,EQ
        MOVL    XAR4,#RAW
        MOVL    XAR5,#RECORD
block:  MOV     AL,*XAR4++
        SUBB    XAR3,#1
        ADDB    AL,#-1
        MOVZ    AR6,@AL
        B       copied,UNC
copy:   MOV     AL,*XAR4++
        MOV     *XAR5++,AL
        SUBB    XAR3,#1
copied: BANZ    copy,AR6--
        MOV     *XAR5++,#0
        MOV     AL,@AR3
        B       block,GT
        MOV     AL,@AR5                 ; the last zero was none of the record
        ADD     @AL,#0xFFFF-RECORD-2
        MOV     @LENGTH,AL
        B       beside,LEQ
        ADDB    AL,#-1
        MOVZ    AR3,@AL
        MOVL    XAR4,#RECORD
        LCR     crc16
        MOV     AH,*+XAR4[1]
        LSL     AH,#8
        OR      AH,*+XAR4[0]
        CMP     AL,@AH
        B       beside,NEQ
        B       request,UNC

send:   MOV     AL,@AR5
        ADD     @AL,#0xFFFF-ANSWER
        MOVZ    AR3,@AL
        MOVL    XAR4,#ANSWER
        LCR     crc16
        LCR     put16
        MOV     *XAR5,#0
        MOVB    AL,#0
        LCR     say
        MOVL    XAR4,#ANSWER
run:    MOVL    XAR6,@XAR4
scan:   MOV     AL,*XAR6++
        B       scan,NEQ
        MOVL    ACC,@XAR6               ; the next zero is so far
        SUBL    ACC,@XAR4
        LCR     say
body:   MOV     AL,*XAR4++
        B       ended,EQ
        LCR     say
        B       body,UNC
ended:  MOVL    ACC,@XAR4
        CMPL    ACC,@XAR5
        B       run,LOS
        MOVB    AL,#0
        LCR     say
        MOV     AL,@LEAVES
        B       beside,EQ
        EALLOW
        MOVW    DP,#WDCR>>6
        MOV     @WDCR,#0x0028           ; the watchdog, which nobody serves
rest:   B       rest,UNC

; AR3: octets but one; XAR4: the first, then behind the last. AL: CRC-16/CCITT-FALSE
crc16:  MOV     AL,#0xFFFF
crcs:   MOV     AH,*XAR4++
        LSL     AH,#8
        XOR     AL,@AH
        MOVB    XAR6,#7
bit16:  LSL     AL,#1
        B       even16,LO
        XOR     @AL,#0x1021
even16: BANZ    bit16,AR6--
        BANZ    crcs,AR3--
        LRETR

say:    MOVW    DP,#SCITX>>6
full:   TBIT    @SCICTL2,#7
        B       full,NTC
        MOV     @SCITX,AL
        MOVW    DP,#BUFFER>>6
        LRETR

; To the answer: AR3 octets from XAR4 on; AL; ACC.
pass:   B       passed,UNC
passon: MOV     AL,*XAR4++
        MOV     *XAR5++,AL
passed: BANZ    passon,AR3--
        LRETR
put16:  MOV     AH,@AL
        ANDB    AL,#0xFF
        MOV     *XAR5++,AL
        LSR     AH,#8
        MOV     *XAR5++,AH
        LRETR
put32:  MOV     @VALUE,AH
        LCR     put16
        MOV     AL,@VALUE
        LCR     put16
        LRETR
; From the request: AL
take16: MOV     AL,*XAR2++
        MOV     AH,*XAR2++
        LSL     AH,#8
        OR      AL,@AH
        LRETR
