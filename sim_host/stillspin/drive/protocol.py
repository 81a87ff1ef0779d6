"""Numbers of the record protocol, version 1: types of requests, status codes, commands, kinds of words."""

from __future__ import annotations

from enum import IntEnum

VERSION = 1
CONTROL_PERIOD = 1e-4
"""Seconds between two control interrupts: what `decimation` 1 of the scope means."""


class Request(IntEnum):
    """Types of requests; an answer has bit 7 set as well."""

    IDENTITY = 0x01
    PARAMETER_INFO = 0x02
    SIGNAL_INFO = 0x03
    PARAMETER_READ = 0x04
    PARAMETER_GET = 0x05
    PARAMETER_SET = 0x06
    COMMAND = 0x07
    STATUS = 0x08
    SIGNALS = 0x09
    FAULT = 0x0A
    WORDS = 0x0B
    LINK = 0x0C
    SCOPE_SETUP = 0x10
    SCOPE_ARM = 0x11
    SCOPE_STATE = 0x12
    SCOPE_READ = 0x13
    SCOPE_STOP = 0x14
    STREAM = 0x15
    COMMISSION_RESULT = 0x16
    LOOK = 0x17
    HIL_ENTER = 0x20
    HIL_STEP = 0x21
    HIL_LEAVE = 0x22


STREAM_EVENT = 0x40


class StatusCode(IntEnum):
    """First octet of every answer."""

    OK = 0
    UNKNOWN = 1
    RANGE = 2
    RUNNING = 3
    LENGTH = 4
    BUSY = 5
    STATE = 6
    CONFLICT = 7
    EDITION = 8


class Command(IntEnum):
    """Codes of Request.COMMAND."""

    START = 1
    STOP = 2
    COAST = 3
    RESET = 4
    SPEED = 5
    COMMISSION = 6
    SAVE = 7
    DEFAULTS = 8
    LOAD = 9
    LOOK = 10


HOLDERS = range(3, 2**31, 2)
"""Arguments of a guarded START or COMMISSION: the drive stops by itself without a STATUS of this number."""


class Words(IntEnum):
    """Kinds of Request.WORDS."""

    STATE = 0
    FAULT = 1
    LIMIT = 2
    VERDICT = 3
    PHASE = 4
    STORE = 5
    STATUS = 6
    START = 7
    REMEDY = 8
    """What to do about a fault."""
    COMMISSIONING = 9
    SCOPE = 10
    CAN = 11
    """State of the drive on the CAN bus."""
    BOARD = 12
    SELFTEST = 13
    WIRING = 14
    """Which phase or sensor is wired wrongly."""
    LOOK = 15


REPEATABLE = frozenset(
    {
        *(Request.IDENTITY, Request.PARAMETER_INFO, Request.SIGNAL_INFO, Request.PARAMETER_READ),
        *(Request.PARAMETER_GET, Request.PARAMETER_SET, Request.STATUS, Request.SIGNALS, Request.FAULT, Request.WORDS),
        Request.LINK,
        *(Request.SCOPE_SETUP, Request.SCOPE_STATE, Request.SCOPE_READ, Request.SCOPE_STOP, Request.STREAM),
        *(Request.COMMISSION_RESULT, Request.LOOK),
    }
)
"""Requests that may reach the drive twice without doing more than once."""
REPEATABLE_COMMANDS = frozenset({Command.STOP, Command.COAST, Command.SPEED})
"""The same for commands: a second START, RESET or SAVE could do what nobody asked for a second time."""
