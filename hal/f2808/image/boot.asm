; From the boot ROM's jump to the C run-time: the only assembly of the image.
;
;   codestart  0x3F7FF6, two words: a branch, for more there is no room before the passwords
;   boot       sector A, programmed once: watchdog off, and on only if the drive in sectors B to D is complete
;   appentry   0x3E8000, part of the drive: zeroes the globals, then TI's _c_int00 (stack, .cinit, main)
;
; The boot ROM leaves OBJMODE 1, AMODE 0, INTM 1, the watchdog RUNNING, the clock at a quarter of what it will be or
; less; zeroing and .cinit take longer than the watchdog waits. The gates are off: their pins are inputs until the drive
; makes them outputs, and the board pulls them down.
;
; The update programs the mark (hal/f2808/image/identity.c.in) last. Without it the CPU stays here, watchdog off, gates
; off: the way back is the boot ROM's serial loader, by the mode pins.

IMAGE_MARK      .set    05AA5h

        .ref    _c_int00
        .ref    _image_identity         ; its first word is the mark
        .ref    _image_globals_start    ; by the linker
        .ref    _image_globals_size     ; words, below 65536

        .sect   "codestart"
        .def    code_start
code_start:
        LB      boot_begin

        .sect   "boot"
boot_begin:
        SETC    OBJMODE                 ; a debugger may come here without the boot ROM
        CLRC    AMODE
        SETC    INTM
        EALLOW
        MOVZ    DP, #7029h>>6           ; WDCR
        MOV     @7029h, #0068h          ; WDDIS, with the check bits 101
        EDIS
        MOVL    XAR7, #_image_identity
        MOV     AL, *+XAR7[0]
        CMP     AL, #IMAGE_MARK
        B       no_image, NEQ
        LB      app_entry
no_image:
        NOP
        B       no_image, UNC

        .sect   "appentry"
        .def    app_entry
app_entry:
        MOVL    XAR6, #_image_globals_start
        MOVL    XAR5, #_image_globals_size
        B       next, UNC
clear:
        MOV     *XAR6++, #0
next:
        BANZ    clear, AR5--
        LB      _c_int00
