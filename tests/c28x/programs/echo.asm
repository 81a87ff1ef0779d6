; A serial echo: each octet comes back, letters in the other case.
        .copy   "start.asm"
main:   LCR     serial
again:  TBIT    @SCIRXST,#6
        B       again,NTC
        MOV     AL,@SCIRX
        ANDB    AL,#0xFF
        MOV     AH,@AL
        ORB     AH,#0x20
        ADDB    AH,#-0x61
        CMPB    AH,#26
        B       plain,HIS
        XORB    AL,#0x20
plain:  MOV     @SCITX,AL
        B       again,UNC
