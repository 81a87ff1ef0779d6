"""Getting the firmware onto the chip: image files, the boot ROM's serial loader, the flash kernel, the update."""
