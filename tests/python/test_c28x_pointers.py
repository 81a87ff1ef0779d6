"""Small assembly programs on the C28x core that go by pointers: buffers, orders, octets, code that moves itself."""

from c28x_desk import Run


def test_circular_buffer_turns_at_its_end():
    run = Run(
        """
        start:  MOVL XAR6,#0x8100       ; a buffer begins where the lower byte is zero
                MOVB XAR1,#3            ; and ends where it is that of AR1
                MOVB XAR0,#5
                MOVB AL,#0
        next:   ADDB AL,#1
                MOV *AR6%++,AL
                BANZ next,AR0--
                ESTOP0
        """,
        reads=[(0x8100, 5)],
    )
    assert run.memory[0] == [5, 6, 3, 4, 0]
    assert (run.registers["xar6"], run.registers["arp"]) == (0x8102, 6)


def test_bit_reversed_order():
    run = Run(
        """
        start:  MOVL XAR0,#4            ; half of eight
                MOVL XAR2,#0x8100
                MOVL XAR3,#0x8200
                MOVB XAR4,#7
        next:   NOP *,ARP2
                MOV AL,*BR0++
                MOV *XAR3++,AL
                BANZ next,AR4--
                ESTOP0
                .org 0x8100
                .word 0, 1, 2, 3, 4, 5, 6, 7
        """,
        reads=[(0x8200, 8)],
    )
    assert run.memory[0] == [0, 4, 2, 6, 1, 5, 3, 7]


def test_bytes_are_packed_two_to_a_word():
    text = b"stillspin"
    run = Run(
        """
        start:  MOVL XAR4,#from
                MOVL XAR5,#to
                MOVB XAR0,#8
        next:   MOVB AL.LSB,*+XAR4[AR0]
                MOVB *+XAR5[AR0],AL.LSB
                BANZ next,AR0--
                ESTOP0
                .org 0x8000
        from:   .word """
        + ",".join(str(int.from_bytes(text[k : k + 2], "little")) for k in range(0, len(text), 2))
        + """
                .org 0x8100
        to:     .word 0, 0, 0, 0, 0xFF00
        """,
        reads=[("TO", 5)],
    )
    got = b"".join(word.to_bytes(2, "little") for word in run.memory[0])
    assert got == text + b"\xff"


def test_code_copies_itself_into_ram_and_runs_there():
    run = Run(
        """
        start:  MOVL XAR7,#there
                MOVL XAR4,#0x8000
                RPT #5
             || PREAD *XAR4++,*XAR7
                LCR 0x8000
                ESTOP0
        there:  MOV @AL,#0x1234
                MOV @AH,#0x5678
                LRETR
        """
    )
    assert (run.end, run.registers["acc"]) == ("breakpoint", 0x56781234)
