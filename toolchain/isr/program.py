"""The image's program with a replay in the place of its registers (tests/m3), and what counts its instructions.

The objects are the image's own, but for the drivers': these are compiled again by the very commands that made them (by
the stand-in for cl2000), with tests/m3/calls.h for hal/f2808/target.h. The replay itself is compiled aside.
"""

import json
import re
import shlex
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import compose
from image import check
from image.command_file import CommandFile, read_command_file
from image.elf import read_object
from image.ram_code import archive_of, runs_from_ram

ROOT = Path(__file__).resolve().parents[2]
REPLAY = ROOT / "tests" / "m3"
PLACES = ROOT / "toolchain" / "c28x" / "f2808_flash.cmd"
COMPILER, EMULATOR, NATIVE = "arm-none-eabi-gcc", "qemu-system-arm", "gcc"
CPU = ("-mcpu=cortex-m3", "-mthumb")
# As the stand-in does: an enumeration is an int; and bool is a word by its header.
ASIDE = (*CPU, "-O2", "-std=c99", "-g", "-Wall", "-Wextra", "-fno-short-enums")
PLUGIN = ("-std=c99", "-O2", "-Wall", "-Wextra", "-fPIC", "-shared")
TABLES = re.compile(r"(?:made|editions/(\w+))/\w+\.c")  # of an edition, in the build's folder
LIBRARIES = re.compile(r"CMakeFiles/(stillspin_\w+)\.dir/")
DRIVERS = "hal/f2808/"
PROGRAMS = re.compile(r"stillspin_(f2808\w*|lamp|flash_kernel)")  # their own starts, and other programs
# A section of the linker's map: name, place, length, object; a long name stands in a line of its own.
MAPPED = re.compile(r"^ (\.text\S*|ramfuncs)\s+(0x[0-9a-f]+)\s+(0x[0-9a-f]+) (\S+)$", re.MULTILINE)
# Of the replay, and of the drive where a step of the control interrupt begins.
MARKS = re.compile(r"mark_\w+|drive_(estimate|protect|control_speed|modulate)|hal_(pwm_write|sci_service)")


@dataclass(frozen=True)
class Function:
    """A function of the linked program: where it is there, and where the image has it.

    Attributes:
        file: its source, from the root of the tree; empty for the compiler's library.
    """

    name: str
    file: str
    start: int
    size: int
    in_ram: bool


@dataclass(frozen=True)
class Objects:
    """What programs are linked of: the drive's objects with their sources, and the replay's."""

    build: Path
    sources: dict[Path, Path]
    aside: list[Path]

    def of(self, edition: str) -> dict[Path, Path]:
        """Those of an edition: its tables, what it has instead of others' sources, and all that has no edition."""
        found = {}
        gone = compose.left_out(compose.read_edition(edition))
        replaced = {source for feature in gone for source in feature.replaced}
        instead = {library: feature in gone for feature in compose.all_features() for library in feature.instead}
        own = f"stillspin_own_{edition}.dir"
        for target, source in self.sources.items():
            inside = source.relative_to(self.build).as_posix() if source.is_relative_to(self.build) else ""
            table = TABLES.fullmatch(inside)
            of_another = "stillspin_own_" in target.as_posix() and own not in target.parts
            library = LIBRARIES.search(target.as_posix())
            if library and library[1] in instead:
                of_another |= not instead[library[1]]
            else:
                of_another |= source.is_relative_to(ROOT) and source.relative_to(ROOT).as_posix() in replaced
            if not of_another and (not table or (table[1] or check.WHOLE) == edition):
                found[target] = source
        return found


@dataclass(frozen=True)
class Program:
    """The linked program, the counting plugin, the functions that count."""

    image: Path
    plugin: Path
    functions: list[Function]
    marks: dict[str, int]


def missing_tools() -> list[str]:
    """What is not installed, as Debian packages."""
    packages = []
    if shutil.which(COMPILER) is None:
        packages.append("gcc-arm-none-eabi libnewlib-arm-none-eabi")
    if shutil.which(EMULATOR) is None:
        packages.append("qemu-system-arm")
    return packages


def commands(build: Path) -> dict[str, list[str]]:
    """Of each object of the drive in a build of the image the command that makes it, without the object's name."""
    found = {}
    for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
        words = shlex.split(entry["command"])
        output = next(word for word in words if word.startswith("--output_file="))
        library = LIBRARIES.search(output)
        if library and not PROGRAMS.fullmatch(library[1]):
            words.remove(output)
            found[output.removeprefix("--output_file=")] = words
    return found


def _source(words: list[str]) -> Path:
    return Path(next(w.removeprefix("--c_file=") for w in words if w.startswith("--c_file=")))


def _compile(build: Path, out: Path) -> dict[Path, Path]:
    """All objects, and the source of each."""
    sources = {}
    jobs = []
    for name, words in commands(build).items():
        target = (out if name.startswith(DRIVERS) else build) / name
        sources[target.resolve()] = _source(words)
        if name.startswith(DRIVERS):
            target.parent.mkdir(parents=True, exist_ok=True)
            jobs.append([*words, f"--preinclude={REPLAY / 'calls.h'}", f"--output_file={target}"])
    with ThreadPoolExecutor(2) as pool:
        list(pool.map(lambda job: subprocess.run(job, check=True, cwd=build), jobs))
    return sources


def _compile_aside(build: Path, out: Path) -> list[Path]:
    """The replay."""
    headers = ("-include", ROOT / "toolchain/standin/include.h", "-include", REPLAY / "calls.h")
    folders = (f"-I{ROOT}", f"-I{build / 'made'}")
    made = []
    for name in ("replay", "startup"):
        made.append((out / f"{name}.o").resolve())
        command = [COMPILER, *ASIDE, *headers, *folders, "-c", REPLAY / f"{name}.c", "-o", made[-1]]
        subprocess.run(command, check=True)
    return made


def _file_of(name: str) -> str:
    command = [COMPILER, *CPU, f"-print-file-name={name}"]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def _link(objects: list[Path], out: Path) -> Path:
    image = out / "replay.elf"
    options = ("-nostartfiles", "--specs=rdimon.specs", "-Wl,--gc-sections,--no-enum-size-warning,--no-warn-execstack")
    first = (_file_of("crti.o"), _file_of("rdimon-crt0.o"))
    places = ("-T", REPLAY / "m3.ld", f"-Wl,-Map,{out / 'replay.map'}")
    command = [COMPILER, *CPU, *options, *places, *first, *objects, _file_of("crtn.o"), "-o", image]
    subprocess.run(command, check=True)
    return image


def functions_of(linked: str, sources: dict[Path, Path], aside: list[Path], placed: CommandFile) -> list[Function]:
    """By the linker's map: those of the drive's objects, and whole members of the compiler's library.

    What of them runs from RAM stands in the image's linker command file.
    """
    text = re.sub(r"^( \.text\S*)\n\s+", r"\1 ", linked, flags=re.MULTILINE)
    places = {
        (found[4], found[1]): (int(found[2], 16), int(found[3], 16))
        for found in MAPPED.finditer(text[text.index("Linker script and memory map") :])
    }
    functions = []
    for target, source in sources.items():
        file = source.relative_to(ROOT).as_posix() if source.is_relative_to(ROOT) else source.name
        obj = read_object(target)
        for symbol in (each for each in obj.symbols if each.is_function and each.section):
            section = obj.sections[symbol.section].name
            start, length = places.get((str(target), section), (0, 0))
            if length:
                in_ram = runs_from_ram(placed, archive_of(target), target.name, section)
                functions.append(Function(symbol.name, file, start + symbol.value, symbol.size, in_ram))
    own = {str(path) for path in (*sources, *aside)}
    for (path, _), (start, length) in places.items():
        if path not in own and length:
            member = re.search(r"\((?:lib_a-)?([^)]+)\.o\)", path)
            functions.append(Function(member[1] if member else Path(path).stem, "", start, length, False))
    return sorted(functions, key=lambda function: function.start)


def marks_of(image: Path) -> dict[str, int]:
    """Where the marks are."""
    symbols = read_object(image).symbols
    return {symbol.name: symbol.value for symbol in symbols if symbol.is_function and MARKS.fullmatch(symbol.name)}


def make(build: Path, out: Path) -> Objects:
    """Compiles what the images in a folder were made of."""
    out.mkdir(parents=True, exist_ok=True)
    return Objects(build, _compile(build, out), _compile_aside(build, out))


def link(objects: Objects, edition: str, out: Path) -> Program:
    """The program of one edition."""
    out.mkdir(parents=True, exist_ok=True)
    sources = objects.of(edition)
    image = _link([*sources, *objects.aside], out)
    plugin = (out / "count.so").resolve()
    subprocess.run([NATIVE, *PLUGIN, REPLAY / "count.c", "-o", plugin], check=True)
    linked = (out / "replay.map").read_text(encoding="utf-8")
    placed = read_command_file(PLACES)
    return Program(image, plugin, functions_of(linked, sources, objects.aside, placed), marks_of(image))
