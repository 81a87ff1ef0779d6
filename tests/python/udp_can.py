"""python-can's own SocketCAN bus without a kernel that has CAN: its frames go over a UDP socket of this computer.

Only the socket is another one than AF_CAN's; frames, time stamps and filters are made and read by python-can as ever.

    python udp_can.py SOCKET stillspin-arguments...      runs stillspin in a process whose CAN interface is that socket
"""

from __future__ import annotations

import os
import socket
import sys
from unittest import mock

from can.interfaces.socketcan import socketcan


def pair():
    """Two sockets that are connected to each other."""
    ends = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2)]
    for end in ends:
        end.bind(("127.0.0.1", 0))
    for end, other in zip(ends, reversed(ends), strict=True):
        end.connect(other.getsockname())
    return ends


def interface(descriptor):
    """While the context lasts every SocketCAN bus that is opened is this socket."""
    return mock.patch.multiple(
        socketcan,
        create_socket=lambda: socket.socket(fileno=os.dup(descriptor)),
        bind_socket=lambda _socket, _channel: None,
    )


if __name__ == "__main__":
    from stillspin.cli import main

    with interface(int(sys.argv.pop(1))):
        main()
