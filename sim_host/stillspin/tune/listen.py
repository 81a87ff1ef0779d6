"""Where the server listens: on the loopback, or for other machines when asked to, with TLS and a token."""

from __future__ import annotations

import ipaddress
import socket
import ssl
from dataclasses import dataclass
from pathlib import Path

from stillspin.errors import InputError

LOOPBACK = "127.0.0.1"
_SHORTEST = 22
"""Characters of a token: 128 bits in base 64."""


@dataclass(frozen=True)
class Outside:
    """An interface for other machines, encrypted, with a token of the user's own."""

    host: str
    tls: ssl.SSLContext
    token: str

    @property
    def name(self) -> str:
        """As it stands in addresses."""
        return f"[{self.host}]" if ":" in self.host else self.host


def outside(host: str, certificate: Path | None, key: Path | None, token: Path | None) -> Outside | None:
    """What the options say; nothing when they say nothing.

    Args:
        host: address or name of one of this machine's interfaces.
        certificate: PEM, with the chain.
        key: PEM, not encrypted.
        token: file with the token in its first line, which others must not be able to read.

    Raises:
        InputError: something is missing, unreadable or too weak.
    """
    given = {"--certificate": certificate, "--key": key, "--token-file": token}
    if not host:
        if any(given.values()):
            raise InputError(f"{', '.join(name for name, file in given.items() if file)}: only together with --listen")
        return None
    if not (certificate and key and token):
        missing = [name for name, file in given.items() if not file]
        raise InputError(
            f"--listen {host}: refused without {' and '.join(missing)}: whoever reaches the page can run the motor, "
            "so other machines need encryption (TLS) and a token"
        )
    _one_interface(host)
    return Outside(host, _tls(certificate, key), _token(token))


def _one_interface(host: str) -> None:
    try:
        everywhere = ipaddress.ip_address(host).is_unspecified
    except ValueError:
        return  # a name
    if everywhere:
        raise InputError(f"--listen {host}: stands for every interface of this machine; give the address of one")


def _tls(certificate: Path, key: Path) -> ssl.SSLContext:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    try:
        context.load_cert_chain(certificate, key, password=lambda: "")
    except OSError as error:
        mismatch = isinstance(error, ssl.SSLError)
        reason = "not a certificate and its key, in PEM" if mismatch else error.strerror
        raise InputError(f"--certificate {certificate}, --key {key}: {reason}") from error
    return context


def _token(file: Path) -> str:
    try:
        if file.stat().st_mode & 0o077:
            raise InputError(f"--token-file {file}: others can read it; chmod 600 {file}")
        token = (file.read_text(encoding="ascii").splitlines() or [""])[0].strip()
    except OSError as error:
        raise InputError(f"--token-file {file}: cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise InputError(f"--token-file {file}: must be letters, digits, - and _") from error
    if len(token) < _SHORTEST or not token.replace("-", "").replace("_", "").isalnum():
        raise InputError(
            f"--token-file {file}: must be {_SHORTEST} or more random letters, digits, - and _; make one with "
            "python3 -c 'import secrets; print(secrets.token_urlsafe())'"
        )
    return token


def listening(host: str, port: int) -> socket.socket:
    """A socket that listens there.

    Raises:
        InputError: it cannot be had.
    """
    try:
        family, kind, protocol, _, where = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        found = socket.socket(family, kind, protocol)
    except OSError as error:
        raise InputError(f"--listen {host}: is no address of this machine ({error.strerror})") from error
    found.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        found.bind(where)
        found.listen(16)
    except OSError as error:
        found.close()
        raise InputError(f"--port {port} on {host}: cannot be opened ({error.strerror})") from error
    return found
