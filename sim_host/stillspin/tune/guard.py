"""Who may talk to the server: the page that was opened with this start's token, and nothing else.

The page can spin a motor, and every web site that is open in the same browser can send requests to the loopback. So a
request must name the server by a loopback name (a name of somebody else's that has been pointed here is refused), must
not come from another origin, and must carry the token of the address that was printed at the start, or the cookie
that the page got for it.
"""

from __future__ import annotations

import secrets
from dataclasses import dataclass, field

from aiohttp import web
from aiohttp.typedefs import Handler, Middleware

HEADERS = {
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; "
        "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    ),
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}
_NAMES = ("127.0.0.1", "localhost", "[::1]")
_DEFAULT_PORTS = {"http": 80, "https": 443}
_OWN_SITE = {"same-origin", "none"}


@dataclass
class Guard:
    """The secrets of one start of the server. `port` is known when it listens."""

    port: int = 0
    names: tuple[str, ...] = _NAMES
    """By which the server may be called; the first is that of its address."""
    scheme: str = "http"
    token: str = field(default_factory=lambda: secrets.token_urlsafe(24))
    session: str = field(default_factory=lambda: secrets.token_urlsafe(24))

    @property
    def cookie(self) -> str:
        """Its name; cookies are shared by all ports of a host."""
        return f"stillspin-{self.port}"

    @property
    def address(self) -> str:
        """What to open in a browser."""
        return f"{self.scheme}://{self.names[0]}:{self.port}/?token={self.token}"

    def complaint(self, request: web.Request) -> str:
        """Why a request is refused; empty when it is not."""
        own = {f"{name}:{self.port}" for name in self.names}
        if self.port == _DEFAULT_PORTS[self.scheme]:
            own |= set(self.names)
        origin = request.headers.get("Origin")
        by_token = request.path == "/" and _same(request.query.get("token", ""), self.token)
        by_cookie = _same(request.cookies.get(self.cookie, ""), self.session)
        site = request.headers.get("Sec-Fetch-Site", "none")
        if request.headers.get("Host", "") not in own:
            return f"this server answers to its own names only: {', '.join(self.names)}"
        if origin is None and "Upgrade" in request.headers:
            return "a connection for live data must say where it comes from"
        if origin is not None and origin not in {f"{self.scheme}://{name}" for name in own}:
            return "requests from other pages are refused"
        if site not in _OWN_SITE and not by_token:
            return "requests from other pages are refused"
        if not (by_token or by_cookie):
            return "open the address that stillspin tune has printed: it has this start's token in it"
        return ""

    def middleware(self) -> Middleware:
        """For an aiohttp application."""

        @web.middleware
        async def check(request: web.Request, handler: Handler) -> web.StreamResponse:
            complaint = self.complaint(request)
            if complaint:
                return web.Response(status=403, text=complaint + "\n", headers=HEADERS)
            response = await handler(request)
            if not response.prepared:
                response.headers.update(HEADERS)
                if request.path == "/":
                    secure = self.scheme == "https"
                    response.set_cookie(
                        self.cookie, self.session, httponly=True, samesite="Strict", path="/", secure=secure
                    )
            return response

        return check


def _same(given: str, secret: str) -> bool:
    return secrets.compare_digest(given.encode(), secret.encode())
