"""Words of the C28x for a Cortex-M3 object's sections.

A byte-sized character has a word there, so a string has as many words as it has bytes here. Everything else in memory
has half as many words as bytes: 16-bit values one word, 32-bit values and pointers two, as on the C28x; bool is widened
when compiling; an enumeration is counted with two words where the C28x needs one. Code: as many words as Thumb-2 has
half words. How close that is to the C28x nobody here knows.
"""

from collections.abc import Callable

from image.elf import ObjectFile, Section

# TI's library: start-up and exit 209, 64-bit quotients, comparisons and logic 317, 16- and 32-bit quotients 76, copying
# and filling 41, by a published map of rts2800_ml.lib 6.4; the rest to 800 for 64-bit products and shifts.
# By a member of each kind.
RUN_TIME_WORDS = {
    **{"boot28.asm.obj": 209, "ll_div28.asm.obj": 317, "l_div28.asm.obj": 76, "memcpy.c.obj": 41},
    "ll_mpy28.asm.obj": 157,
}
RUN_TIME_LIBRARY = "rts2800_ml.lib"
PACKED_TEXT = ".rodata.packed_"  # what toolchain/pack_text.py makes
CINIT_OVERHEAD = 3  # words of a .cinit record beside its values


def section_of(section: Section) -> str | None:
    """The name that TI's compiler would use; None for what is not in memory."""
    if not section.allocated or section.size == 0 or section.name.startswith(".ARM"):
        return None
    for prefix, name in ((".text", ".text"), (".rodata", ".econst"), (".data", ".ebss"), (".bss", ".ebss")):
        if section.name.startswith(prefix):
            return name
    return section.name


def input_section(section: Section) -> str | None:
    """The same, of a function's code with its own part of the name: `.text:_NAME`."""
    return f".text:_{section.name[6:]}" if section.name.startswith(".text.") else section_of(section)


def words_of(section: Section) -> int:
    """Estimated words."""
    return section.size if section.is_strings else (section.size + 1) // 2


def object_words(obj: ObjectFile, name_of: Callable[[Section], str | None] = section_of) -> dict[str, int]:
    """Words by section; strings also by themselves."""
    words: dict[str, int] = {}
    for section in obj.sections:
        name = name_of(section)
        if name is None:
            continue
        count = words_of(section)
        words[name] = words.get(name, 0) + count
        if section.is_strings or section.name.startswith(PACKED_TEXT):
            words["strings"] = words.get("strings", 0) + count
        if section.name.startswith(".data"):
            words[".cinit"] = words.get(".cinit", 0) + count + CINIT_OVERHEAD
    return words
