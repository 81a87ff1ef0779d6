"""The changes that `make mutants` makes to a C source, one at a time.

Of the tokens outside comments, strings and directives (of a #define its body counts): relations, sums, products and
shifts, logical and bit operators, signs, constants by one either way, truth values, conditions negated, statements
left out. Of a constant above a thousand one is less than its rounding: it changes by a sixteenth.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass

TOKENS = re.compile(
    r"(?P<skip>/\*.*?\*/|//[^\n]*|\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])*'|\s+|\\\n)"
    r"|(?P<define>^[ \t]*#[ \t]*define[ \t]+\w+(?:\([^)]*\))?)|(?P<directive>^[ \t]*#(?:\\\n|[^\n])*)"
    r"|(?P<number>\b(?:0[xX][0-9a-fA-F]+|\d+)[uUlL]*\b)|(?P<word>[A-Za-z_]\w*)"
    r"|(?P<sign><<=|>>=|->|\+\+|--|&&|\|\||<<|>>|[-+*/%&|^<>=!]=|.)",
    re.DOTALL | re.MULTILINE,
)
BINARY = {
    **{"<": ("<=", ">"), "<=": ("<", ">="), ">": (">=", "<"), ">=": (">", "<="), "==": ("!=",), "!=": ("==",)},
    **{"&&": ("||",), "||": ("&&",), "+": ("-",), "-": ("+",), "*": ("/",), "/": ("*",), "%": ("*",)},
    **{"<<": (">>",), ">>": ("<<",), "&": ("|",), "|": ("&",), "^": ("|",), "+=": ("-=", "="), "-=": ("+=", "=")},
    **{"*=": ("/=",), "/=": ("*=",), "|=": ("&=", "="), "&=": ("|=", "="), "<<=": (">>=",), ">>=": ("<<=",)},
}
EITHER = {"++": ("--",), "--": ("++",)}
LARGE = 1000
WORDS = {"true": "false", "false": "true"}
NOT_A_STATEMENT = {
    *("return", "if", "for", "while", "switch", "case", "default", "do", "goto", "const", "static", "typedef"),
    *("extern", "struct", "union", "enum", "else", "unsigned", "signed", "int", "char", "continue", "inline"),
}


@dataclass(frozen=True)
class Token:
    """A token and its place."""

    kind: str
    text: str
    at: int

    @property
    def end(self) -> int:
        """Behind its last character."""
        return self.at + len(self.text)


@dataclass(frozen=True)
class Mutant:
    """Characters of a source that are replaced by others."""

    file: str
    at: int
    end: int
    new: str

    def applied(self, source: str) -> str:
        """The changed source."""
        return source[: self.at] + self.new + source[self.end :]

    def told(self, source: str) -> str:
        """What is changed, for people."""
        line = source.count("\n", 0, self.at) + 1
        old = " ".join(source[self.at : self.end].split())
        shown = source.splitlines()[line - 1].strip()
        return f"{self.file}:{line}: {old} -> {self.new or '(nothing)'}    in: {shown}"


def tokens(source: str) -> list[Token]:
    """Those that count."""
    found = (Token(m.lastgroup or "", m.group(), m.start()) for m in TOKENS.finditer(source))
    return [token for token in found if token.kind not in ("skip", "directive", "define")]


def of_constant(token: Token) -> Iterator[str]:
    """Some more and some less."""
    digits = token.text.rstrip("uUlL")
    suffix = token.text[len(digits) :]
    value = int(digits, 0) if digits.lower().startswith("0x") else int(digits)
    step = 1 if value <= LARGE else value // 16
    yield f"{value + step}{suffix}"
    if value > 0:
        yield f"{value - step}{suffix}"


def of_token(before: Token | None, token: Token) -> Iterator[str]:
    """What may stand in a token's place."""
    joins = before is not None and (before.kind in ("number", "word") or before.text in (")", "]"))
    joins = joins and before is not None and before.text != "return"
    if token.text == "*" and before is not None and before.text.endswith("_t"):
        return  # a pointer's type
    if token.kind == "number":
        yield from of_constant(token)
    elif token.text in WORDS:
        yield WORDS[token.text]
    elif token.text in EITHER:
        yield from EITHER[token.text]
    elif token.text in BINARY and joins:
        yield from BINARY[token.text]
    elif token.text in ("-", "!", "~"):
        yield ""


def closing(found: list[Token], opening: int) -> int:
    """The index of the parenthesis that closes the one at an index."""
    depth = 0
    for k in range(opening, len(found)):
        depth += {"(": 1, ")": -1}.get(found[k].text, 0)
        if depth == 0:
            return k
    return len(found) - 1


def is_statement(found: list[Token], k: int) -> bool:
    """Whether an expression statement, or a break, begins at an index."""
    first, second = found[k], found[k + 1] if k + 1 < len(found) else found[k]
    if first.kind != "word" and first.text not in ("*", "(", "++", "--"):
        return False
    declares = first.kind == "word" and (second.kind == "word" or second.text in ("*", ":"))
    return first.text not in NOT_A_STATEMENT and not declares


def statements(found: list[Token]) -> Iterator[tuple[int, int]]:
    """First and last character of statements inside functions, their semicolon left standing."""
    depth = 0
    heads = {closing(found, k + 1) for k, t in enumerate(found[:-1]) if t.text in ("if", "for", "while", "switch")}
    for k, token in enumerate(found[:-1]):
        depth += {"{": 1, "}": -1}.get(token.text, 0)
        starts = token.text in ("{", "}", ";", "else", ":") or k in heads
        if depth == 0 or not starts or not is_statement(found, k + 1):
            continue
        last = next((j for j in range(k + 1, len(found)) if found[j].text in (";", "{", "}", "?")), None)
        if last is not None and found[last].text == ";" and last > k + 1:
            yield found[k + 1].at, found[last].at


def mutants(file: str, source: str) -> list[Mutant]:
    """All of a source, in its order."""
    found = tokens(source)
    made = []
    for k, token in enumerate(found):
        before = found[k - 1] if k > 0 else None
        made += [Mutant(file, token.at, token.end, new) for new in of_token(before, token)]
        if token.text in ("if", "while") and k + 1 < len(found):
            opening, close = found[k + 1], found[closing(found, k + 1)]
            made.append(Mutant(file, opening.at, close.end, f"(!{source[opening.at : close.end]})"))
    made += [Mutant(file, start, end, "") for start, end in statements(found)]
    return sorted(set(made), key=lambda m: (m.at, m.end, m.new))
