"""Addresses of drives, taken apart.

serial:///dev/ttyUSB0?baud=115200     a serial port; /dev/ttyUSB0 and COM3 alone mean the same
can:slcan:/dev/ttyACM0?node=1         an SLCAN adapter; bitrate=500000
can:socketcan:can0?node=1             the kernel's CAN
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from urllib.parse import parse_qsl, urlsplit

from stillspin.errors import InputError, did_you_mean
from stillspin.link.segments import DEFAULT_BITRATE, NODES
from stillspin.link.serial_port import DEFAULT_BAUD
from stillspin.quantity import Range

_FORMS = "serial:///dev/ttyUSB0, can:slcan:/dev/ttyACM0?node=1, can:socketcan:can0?node=1 or virtual:"


@dataclass(frozen=True)
class Address:
    """An address taken apart."""

    kind: str
    """serial, can or virtual"""
    channel: str
    interface: str = ""
    options: Mapping[str, int] = field(default_factory=dict)


def parse(text: str) -> Address:
    """The parts of an address.

    Raises:
        InputError: it is none.
    """
    scheme, colon, _ = text.partition(":")
    if not colon or len(scheme) == 1 or "/" in scheme:  # a bare port name; C: and the like are no scheme
        return Address("serial", text, options={"baud": DEFAULT_BAUD}) if text else _bad(text)
    body, _, query = text.partition("?")
    if scheme == "serial":
        parts = urlsplit(body)
        channel = parts.netloc + parts.path
        return Address("serial", channel or _no_port(text), options=_options(text, query, {"baud": DEFAULT_BAUD}))
    if scheme == "can":
        interface, _, channel = body.removeprefix("can:").partition(":")
        if not interface or not channel:
            return _bad(text)
        options = _options(text, query, {"node": 1, "bitrate": DEFAULT_BITRATE})
        if options["node"] not in NODES:
            raise InputError(f"address '{text}': node must be {NODES[0]} … {NODES[-1]}")
        return Address("can", channel, interface, options)
    if scheme == "virtual":
        return Address("virtual", body.removeprefix("virtual:") or "bench", options=_options(text, query, {"speed": 1}))
    return _bad(text)


def _options(text: str, query: str, known: dict[str, int]) -> dict[str, int]:
    options = dict(known)
    for name, value in parse_qsl(query, keep_blank_values=True):
        if name not in known:
            raise InputError(f"address '{text}': no option '{name}'{did_you_mean(name, known)}")
        options[name] = Range(0, whole=True).read_whole(value, f"address '{text}': {name}")
    return options


def _no_port(text: str) -> str:
    raise InputError(f"address '{text}' names no port; must be like {_FORMS}")


def _bad(text: str) -> Address:
    raise InputError(f"address '{text}': must be like {_FORMS}")
