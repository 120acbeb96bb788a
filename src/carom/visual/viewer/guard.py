"""Who may talk to a live view: requests whose Host and Origin are those of this server.

A page of another site can make the browser send requests to this machine, also by a name of its own that it
lets point here (DNS rebinding). Such a request has that name as Host, or its own site as Origin. viser has no
setting for this, so the function of the package websockets by which it serves is wrapped while it starts.
"""

from __future__ import annotations

import http
import ipaddress
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any
from urllib.parse import urlsplit

_ONE_AT_A_TIME = threading.Lock()
REFUSED = "This view can be opened by the address that it was started with only.\n"


def admits(host: str, headers) -> bool:
    """Return whether a request with these headers is one to the server at `host`.

    Its Host must be an address in numbers, which no other name stands for, or a name of this machine. Its
    Origin, which browsers send with all that pages ask for, must be the same server.
    """
    hosts, origins = headers.get_all("Host"), headers.get_all("Origin")
    if len(hosts) != 1 or len(origins) > 1 or not _is_own(host, hosts[0]):
        return False
    return not origins or urlsplit(origins[0]).netloc.lower() == hosts[0].lower()


def _is_own(host: str, netloc: str) -> bool:
    try:
        name = (urlsplit(f"//{netloc}").hostname or "").rstrip(".").lower()
    except ValueError:
        return False
    machine = socket.gethostname().lower()
    if name in ("localhost", host.lower(), machine, f"{machine}.local"):
        return True
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


@contextmanager
def guarded(host: str) -> Iterator[list]:
    """Let a viser server that starts within answer own requests only.

    Yield a list that stays empty if it serves in another way, which is not safe.
    """
    import websockets.asyncio.server as served

    serve, used = served.serve, []

    def watched(handler, *given, process_request: Callable | None = None, **settings: Any):
        used.append(handler)

        def checked(connection, request):
            if not admits(host, request.headers):
                return connection.respond(http.HTTPStatus.FORBIDDEN, REFUSED)
            return None if process_request is None else process_request(connection, request)

        return serve(handler, *given, process_request=checked, **settings)

    with _ONE_AT_A_TIME:
        served.serve = watched  # pyright: ignore[reportAttributeAccessIssue]
        try:
            yield used
        finally:
            served.serve = serve
