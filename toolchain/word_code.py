"""A dictionary of the texts' words, and the codes of its entries and of their letters.

Code words are as long as what they stand for is rare (D. Huffman, "A Method for the Construction of Minimum-Redundancy
Codes", Proc. IRE 40(9), 1952), those of a length follow each other, so that a table of how many have each length is all
that reading needs. Between two words their text's joint, a space or an underscore, is not said; a number is a word as
well. Words that stand side by side often are an entry of their own, and so are the endings that words share.
"""

import heapq
import math
import re
from collections import Counter
from collections.abc import Iterable, Mapping
from itertools import count, pairwise

END = ""  # of a text, and of a word, in the place of an entry or of a letter
GLUED = "\2"  # first letter of an entry that follows what is before it without a joint
SPELLED = "\1"  # in the place of an entry: a word's letters follow
WORD = re.compile(r"[A-Za-z0-9]+|.")
LETTER_BITS = 4.0  # of a letter of the dictionary, about
LONGEST = 16  # bits of a code, as firmware/text/packed_text.c takes them
ENDINGS = ("s", "d", "ed", "ing")
STEM = 3  # letters that are left of a word at least
WORTH = 4  # bits that an entry of several words has to save


def words(text: str, joint: str = " ") -> list[str]:
    """The words and other characters of a text, without the joint between two words."""
    found = WORD.findall(text)
    around = zip(["", *found], found, [*found[1:], ""], strict=False)
    return [word for before, word, behind in around if word != joint or not _joins(before, behind)]


def joined(first: str, second: str, joint: str = " ") -> str:
    """What two entries that follow each other say."""
    if second.startswith(GLUED):
        return first + second[1:]
    return first + joint + second if _joins(first, second) else first + second


def _joins(first: str, second: str) -> bool:
    return first[-1:].isalnum() and second[:1].isalnum()


def stems(texts: list[list[str]]) -> None:
    """Takes the endings of words whose stem is a word as well, or has another ending elsewhere, in place."""
    said = {word for text in texts for word in text if word.isalpha()}
    cuts = {word: [(word[: -len(end)], end) for end in ENDINGS if word.endswith(end)] for word in said}
    kin = Counter(stem for found in cuts.values() for stem, _ in found) + Counter(said)
    parts = {
        word: next(([stem, GLUED + end] for stem, end in found if len(stem) >= STEM and kin[stem] > 1), [word])
        for word, found in cuts.items()
    }
    for text in texts:
        text[:] = [part for word in text for part in parts.get(word, [word])]


def _bits(all_of_them: int, *counts: int) -> float:
    """What so many take in a code, beside the others."""
    return all_of_them * math.log2(all_of_them) - sum(n * math.log2(n) for n in counts if n)


def _saving(pair: tuple[str, str, str], together: int, single: Mapping[str, int], total: int) -> float:
    """Bits saved by an entry for two that stand together so often, behind them their joint."""
    first, second, _ = pair

    def entry(text: str) -> float:
        return LETTER_BITS * (len(text) + 1)

    rest = single[first] - together, single[second] - together
    gone = sum(entry(text) for text, n in zip((first, second), rest, strict=True) if n == 0)
    before = _bits(total, single[first], single[second])
    return before - _bits(total - together, *rest, together) + gone - entry(joined(*pair))


def phrases(texts: list[list[str]], joints: list[str]) -> None:
    """Makes of words that stand together often one, in place, the most saving first. Each text has its joint."""
    while True:
        single = Counter(word for text in texts for word in text)
        pairs = Counter(
            (*pair, joint)
            for text, joint in zip(texts, joints, strict=True)
            for pair in pairwise(text)
            if pair[0] != pair[1]
        )
        total = single.total() + len(texts)
        savings = {pair: _saving(pair, n, single, total) for pair, n in pairs.items() if n > 1}
        best = max(savings, key=lambda pair: (savings[pair], pair), default=None)
        if best is None or savings[best] < WORTH:
            return
        for text, joint in zip(texts, joints, strict=True):
            at = 0
            while at + 1 < len(text):
                if (text[at], text[at + 1], joint) == best:
                    text[at : at + 2] = [joined(*best)]
                at += 1


class Code:
    """A canonical Huffman code.

    Raises:
        ValueError: a code is longer than the reader takes.
    """

    def __init__(self, frequencies: Mapping[str, int]) -> None:
        ties = count()
        heap = [(n, next(ties), [symbol]) for symbol, n in sorted(frequencies.items())]
        heapq.heapify(heap)
        length = dict.fromkeys(frequencies, 0)
        while len(heap) > 1:
            n, _, one = heapq.heappop(heap)
            m, _, other = heapq.heappop(heap)
            for symbol in one + other:
                length[symbol] += 1
            heapq.heappush(heap, (n + m, next(ties), one + other))
        if max(length.values()) > LONGEST:
            raise ValueError(f"a code of {max(length.values())} bits, where the reader takes {LONGEST}")
        self.symbols = sorted(frequencies, key=lambda symbol: (length[symbol], symbol))  # in the order of their codes
        self.counts = [list(length.values()).count(k) for k in range(1, max(length.values()) + 1)]
        self._bits: dict[str, str] = {}
        code, bits = 0, 0
        for symbol in self.symbols:
            code <<= length[symbol] - bits
            bits = length[symbol]
            self._bits[symbol] = f"{code:0{bits}b}"
            code += 1

    def of(self, symbols: Iterable[str]) -> str:
        """Their bits."""
        return "".join(self._bits[symbol] for symbol in symbols)


def entries(texts: list[list[str]]) -> Counter[str]:
    """How often each of the dictionary is said. The end and what is spelled count so often that they come first."""
    said = Counter(word for text in texts for word in text)
    found = Counter({word: n for word, n in said.items() if n > 1 or len(word) == 1})
    most = max(found.values(), default=0)
    found[SPELLED] = max(said.total() - found.total(), most + 1)
    found[END] = max(len(texts), found[SPELLED] + 1)
    return found
