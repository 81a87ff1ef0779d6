"""The packing of the firmware's texts: what is found in the lists, and that it can be unpacked."""

import re
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

import compose  # noqa: E402
import pack_text  # noqa: E402


def unpacked(code: int, pairs: list[tuple[int, int]]) -> str:
    if code < pack_text.FIRST_PAIR:
        return chr(code)
    return "".join(unpacked(half, pairs) for half in pairs[code - pack_text.FIRST_PAIR])


def test_arguments_of_a_macro_are_found() -> None:
    text = 'FAULT(1, A, "no", "")  // FAULT(2, B, "comment", "")\nOTHER(3)\nFAULT(4, f(a, b),\n  "x, (y"\n " z")'
    assert pack_text.rows(text, "FAULT")[0] == ["1", "A", "no", ""]
    assert pack_text.rows(text, "FAULT")[-1] == ["4", "f(a,b)", "x, (y z"]


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
        pack_text.texts(tmp_path)


def test_unpacking_gives_the_texts_back() -> None:
    texts = list(pack_text.texts().values())
    coded = [[ord(c) for c in text] for text in texts]
    pairs = pack_text.squeeze(coded)
    assert ["".join(unpacked(code, pairs) for code in string) for string in coded] == texts
    assert sum(map(len, coded)) < 0.55 * sum(map(len, texts))


def test_pairs_are_not_deeper_than_the_firmware_can_read() -> None:
    def depth(code: int) -> int:
        if code < pack_text.FIRST_PAIR:
            return 0
        return 1 + max(depth(half) for half in pairs[code - pack_text.FIRST_PAIR])

    pairs = pack_text.squeeze([[ord("a")] * 2000 for _ in range(40)])
    assert max(depth(pack_text.FIRST_PAIR + k) for k in range(len(pairs))) == pack_text.DEPTH


def test_texts_that_are_the_same_share_their_octets() -> None:
    def table(source: str, name: str) -> list[int]:
        found = re.search(rf"{name}\[\] = \{{([^}}]*)\}}", source)
        assert found
        return [int(word, 16) for word in found[1].replace(",", " ").split()]

    source = pack_text.pack(["rpm", "a text", "rpm", ""])
    starts = table(source, "packed_starts")
    assert starts[0] == starts[2] and len(set(starts)) == 3
    assert len(table(source, "packed_octets")) == (len("rpm") + len("a text") + 3 + 1) // 2


@pytest.mark.parametrize("text", ["10 µs", "line\\n"])
def test_what_the_console_cannot_show_is_refused(tmp_path: Path, text: str) -> None:
    (tmp_path / "firmware" / "text").mkdir(parents=True)
    (tmp_path / "firmware" / "text" / "catalogue_list.h").write_text(f'WORDS(STATE, 0, "{text}")\n', encoding="utf-8")
    with pytest.raises(ValueError, match="plain ASCII"):
        pack_text.texts(tmp_path)
