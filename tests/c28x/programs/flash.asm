; The inner loop of a flash kernel on TI's flash library: erases sector D, then programs and verifies a table piece by
; piece, and stops at the first status that is not zero. It and the library run from H0, where a probe or a loader has put
; them; what the library's functions do is the virtual chip's.
; From 0x8000 on: statuses of the erase, the last programming, the last verification; pieces that are done; where to go on.
        .copy   "start.asm"
        .global ERASED, PROGRAMMED, VERIFIED, PIECES, NEXT, STATUS
ERASED  .set    0x8000
PROGRAMMED .set 0x8001
VERIFIED .set   0x8002
PIECES  .set    0x8003
NEXT    .set    0x8004
STATUS  .set    0x8010
SECTOR  .set    0x3E8000
SIZE    .set    8
COUNT   .set    4

main:   LCR     kernel
        LRETR

table:  .word   0x1234, 0xFFFF, 0x0000, 0xA5A5, 1, 2, 3, 4
        .word   11, 12, 13, 14, 15, 16, 17, 18
        .word   21, 22, 23, 24, 25, 26, 27, 28
        .word   31, 32, 33, 34, 35, 36, 37, 38

        .org    0xA000
kernel: MOV     AH,#0x0140              ; 2^20 x 200 ns / 10 ns
        MOV     AL,#0
        MOVL    XAR4,#Flash_CPUScaleFactor
        MOVL    *XAR4,ACC
        MOVW    DP,#ERASED>>6
        MOV     @PIECES,#0
        MOV     @PROGRAMMED,#0xFFFF
        MOV     @VERIFIED,#0xFFFF
        MOVL    XAR4,#SECTOR
        MOVL    @NEXT,XAR4
        MOV     AL,#8                   ; sector D
        MOVL    XAR4,#STATUS
        LCR     Flash2808_Erase
        MOVW    DP,#ERASED>>6
        MOV     @ERASED,AL
        CMPB    AL,#0
        B       done,NEQ
        MOVL    XAR7,#table
        MOVL    XAR2,#COUNT-1
piece:  MOVL    XAR5,#buffer
        RPT     #SIZE-1
     || PREAD   *XAR5++,*XAR7
        ADDB    XAR7,#SIZE
        MOVL    XAR6,#STATUS
        MOVL    *SP++,XAR6
        MOVL    XAR4,@NEXT
        MOVL    XAR5,#buffer
        MOVB    ACC,#SIZE
        LCR     Flash2808_Program
        MOVW    DP,#ERASED>>6
        MOV     @PROGRAMMED,AL
        CMPB    AL,#0
        B       failed,NEQ
        MOVL    XAR4,@NEXT
        MOVL    XAR5,#buffer
        MOVB    ACC,#SIZE
        LCR     Flash2808_Verify
        MOVW    DP,#ERASED>>6
        MOV     @VERIFIED,AL
        SUBB    SP,#2
        CMPB    AL,#0
        B       done,NEQ
        MOVL    ACC,@NEXT
        ADDB    ACC,#SIZE
        MOVL    @NEXT,ACC
        INC     @PIECES
        BANZ    piece,AR2--
        LRETR
failed: SUBB    SP,#2
done:   LRETR

; In the place of TI's code, which is in no public source: whoever executes this has no library in its place.
Flash2808_Erase:
        ESTOP0
Flash2808_Program:
        ESTOP0
Flash2808_Verify:
        ESTOP0

        .org    0xA080
Flash_CPUScaleFactor:
        .long   0
buffer: .word   0, 0, 0, 0, 0, 0, 0, 0
