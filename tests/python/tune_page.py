"""A browser's end of the page: what it sends, and the page's end of the live connection."""

import asyncio
import http.client
import json

import aiohttp


def get(server, path, headers=None, method="GET"):
    """Status, headers and body; `headers` replace what a browser would send."""
    connection = http.client.HTTPConnection("127.0.0.1", server.guard.port, timeout=5)
    connection.putrequest(method, path, skip_host=True)
    for name, value in {"Host": f"127.0.0.1:{server.guard.port}", **(headers or {})}.items():
        connection.putheader(name, value)
    connection.endheaders()
    answer = connection.getresponse()
    return answer.status, dict(answer.getheaders()), answer.read().decode(errors="replace")


def cookie(server):
    return {"Cookie": f"{server.guard.cookie}={server.guard.session}"}


def live(server, **changed):
    """What a browser sends to open the live connection from the page itself."""
    own = f"127.0.0.1:{server.guard.port}"
    headers = {
        "Host": own,
        "Origin": f"http://{own}",
        "Upgrade": "websocket",
        "Connection": "Upgrade",
        "Sec-WebSocket-Version": "13",
        "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA==",
        **cookie(server),
    }
    headers |= {name.replace("_", "-"): value for name, value in changed.items()}
    return get(server, "/live", {name: value for name, value in headers.items() if value is not None})


class Page:
    """The page's end of the live connection."""

    def __init__(self, socket):
        self.socket, self.number, self.seen = socket, 0, []

    async def hear(self, kind):
        while True:
            message = json.loads((await self.socket.receive(timeout=10)).data)
            self.seen.append(message)
            if message["t"] == kind:
                return message

    async def ask(self, what, **given):
        self.number += 1
        await self.socket.send_json({"t": "ask", "id": self.number, "what": what, "given": given})
        while True:
            reply = await self.hear("reply")
            if reply["id"] == self.number:
                return reply

    async def say(self, **message):
        await self.socket.send_json(message)


def talk(server, conversation):
    """Run a coroutine with a page that is connected."""

    async def connected():
        own = f"http://127.0.0.1:{server.guard.port}"
        async with (
            aiohttp.ClientSession(headers=cookie(server)) as session,
            session.ws_connect(f"{own}/live", origin=own) as socket,
        ):
            await asyncio.wait_for(conversation(Page(socket)), 60)  # s: what never comes is a failure, no hang

    asyncio.run(connected())
