"""What the interrupts take: counted on an emulated Cortex-M3, bounded by its program's longest paths, on the host."""
