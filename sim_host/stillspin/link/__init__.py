"""The wire to a drive: COBS, CRC-16, records between lines of text, and what carries them."""
