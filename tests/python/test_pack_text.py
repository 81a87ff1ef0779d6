"""The packing of the firmware's texts: what is found in the lists, and that it can be unpacked."""

import re
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

import compose  # noqa: E402
import pack_text  # noqa: E402
import word_code  # noqa: E402
from row_lists import Lists  # noqa: E402


def table(source: str, name: str) -> list[int]:
    found = re.search(rf"{name}\[\] = \{{([^}}]*)\}}", source)
    assert found
    return [int(word, 16) for word in found[1].replace(",", " ").split()]


class Unpacked:
    """The tables read again, bit by bit, by code words that are looked up."""

    def __init__(self, source: str) -> None:
        self.bits = [f"{word:016b}" for word in table(source, "packed_bits")]
        self.starts = table(source, "packed_starts")
        self.letters = [octet for pair in table(source, "packed_letters") for octet in (pair & 0xFF, pair >> 8)]
        self.letter_codes = self.codes(table(source, "packed_letter_counts"))
        self.entry_codes = self.codes(table(source, "packed_entry_counts"))
        blocks = table(source, "packed_dictionary")
        entries = len(self.entry_codes)
        self.dictionary = [
            word
            for k, at in enumerate(blocks)
            for word in self.words(at, min(pack_text.BLOCK, entries - pack_text.BLOCK * k))
        ]

    @staticmethod
    def codes(counts: list[int]) -> dict[str, int]:
        found: dict[str, int] = {}
        code = 0
        for length, count in enumerate(counts, 1):
            code *= 2
            for _ in range(count):
                found[f"{code:0{length}b}"] = len(found)
                code += 1
        return found

    def read(self, bits: Iterator[str], codes: dict[str, int]) -> int:
        code = ""
        while code not in codes:
            code += next(bits)
        return codes[code]

    def to_the_end(self, bits: Iterator[str], codes: dict[str, int]) -> Iterator[int]:
        while (code := self.read(bits, codes)) != 0:
            yield code

    def at(self, word: int) -> Iterator[str]:
        return iter("".join(self.bits[word:]))

    def word(self, bits: Iterator[str]) -> str:
        return "".join(chr(self.letters[k]) for k in self.to_the_end(bits, self.letter_codes))

    def words(self, at: int, count: int) -> list[str]:
        bits = self.at(at)
        return [self.word(bits) for _ in range(count)]

    def texts(self, count: int, names: int = 0) -> list[str]:
        found: list[str] = []
        for k, at in enumerate(self.starts):
            bits = self.at(at)
            for _ in range(min(pack_text.BLOCK, count - pack_text.BLOCK * k)):
                text = ""
                joint = " " if len(found) < count - names else "_"
                for entry in self.to_the_end(bits, self.entry_codes):
                    text = word_code.joined(text, self.word(bits) if entry == 1 else self.dictionary[entry], joint)
                found.append(text)
        return found


def test_every_list_has_its_texts() -> None:
    texts = pack_text.texts()
    assert texts["TEXT_PARAMETER_stator_resistance"] == "stator resistance of a phase"
    assert texts["TEXT_FAULT_12"] == "loss of synchronism"
    assert texts["SAY_nothing_has_been_recorded"].startswith("nothing has been recorded"), "a folder's own list"
    assert {"stator_resistance", "ohm", "speed", "commission"} <= set(texts.values())


def test_texts_are_numbered_as_they_are_packed() -> None:
    made = compose.made(compose.read_edition("lab"))
    names = re.findall(r"^  (\w+),?$", made[pack_text.NUMBERS], re.MULTILINE)
    assert names == [*pack_text.texts(), "PACKED_TEXTS"]


def test_two_texts_of_a_name_are_refused(tmp_path: Path) -> None:
    for folder in ("scope", "can"):
        (tmp_path / "firmware" / folder).mkdir(parents=True)
        (tmp_path / "firmware" / folder / "phrase_list.h").write_text('PHRASE(none, "none")\n', encoding="utf-8")
    with pytest.raises(ValueError, match="SAY_none is there twice"):
        pack_text.texts(Lists(tmp_path))


@pytest.mark.parametrize("edition", ["lab", "minimal"])
def test_unpacking_gives_the_texts_back(edition: str) -> None:
    whole = compose.read_edition(edition)
    needless = compose.needless_texts(whole, ROOT)
    kept = ["" if name in needless else text for name, text in pack_text.texts().items()]
    source = compose.made(whole)[compose.TEXTS]
    names = sum(1 for name in pack_text.texts() if pack_text.NAME.match(name))
    assert Unpacked(source).texts(len(kept), names) == kept
    words = sum(len(found.split()) for found in re.findall(r"\{([^}]*)\};", source))
    assert words < 0.21 * sum(len(text) + 1 for text in kept), "about a fifth of the characters"


@pytest.mark.parametrize(
    "texts",
    [
        ["rpm", "a text", "rpm", ""],
        ["", ""],
        [
            " ",
            "  a  b ",
            "a1b",
            "a 1 b2 3_c",
            "_a_b_",
            "a - b",
            "an (e)",
            "~",
            " of the set",
            "of the ",
            "aa aa aa",
        ]
        * 3,
        ["turn turns turned turning", "load_turns s ed", "s", "_ed", "sing sings", "he led the ring", "turn"],
    ],
)
@pytest.mark.parametrize("names", [0, 2])
def test_what_is_between_two_words_is_kept(texts: list[str], names: int) -> None:
    assert Unpacked(pack_text.pack(texts, names)).texts(len(texts), names) == texts


def test_a_code_longer_than_the_reader_takes_is_refused():
    fibonacci = {
        chr(97 + k): n for k, n in enumerate((1, 1, 2, 3, 5, 8, 13, 21, 34, 55, 89, 144, 233, 377, 610, 987, 1597))
    }
    assert len(word_code.Code(fibonacci).counts) == 16
    with pytest.raises(ValueError, match="17 bits"):
        word_code.Code({**fibonacci, "z": 2584})


def test_a_code_word_is_as_long_as_its_symbol_is_rare() -> None:
    code = word_code.Code({"e": 8, "a": 4, "b": 2, "c": 1, "d": 1})
    assert [code.of([symbol]) for symbol in "eabcd"] == [
        "0",
        "10",
        "110",
        "1110",
        "1111",
    ]
    assert code.counts == [1, 1, 1, 2]


def test_words_that_stand_together_often_are_an_entry() -> None:
    texts = [["the", "power", "stage", other] for other in "abcdefghij"]
    word_code.phrases(texts, [" "] * 10)
    assert texts[0] == ["the power stage", "a"]


def test_words_of_a_name_and_of_a_sentence_are_two_entries() -> None:
    texts = [["power", "stage", str(other)] for other in range(2000)]
    word_code.phrases(texts, [" "] * 1000 + ["_"] * 1000)
    assert (texts[0], texts[1000]) == (["power stage", "0"], ["power_stage", "1000"])


@pytest.mark.parametrize("text", ["10 µs", "line\\n"])
def test_what_the_console_cannot_show_is_refused(tmp_path: Path, text: str) -> None:
    (tmp_path / "firmware" / "text").mkdir(parents=True)
    (tmp_path / "firmware" / "text" / "catalogue_list.h").write_text(f'WORDS(STATE, 0, "{text}")\n', encoding="utf-8")
    with pytest.raises(ValueError, match="plain ASCII"):
        pack_text.texts(Lists(tmp_path))
