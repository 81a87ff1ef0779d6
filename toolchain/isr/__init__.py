"""What the interrupts cost on the chip, by the image's own program; and what a native control interrupt costs here."""
