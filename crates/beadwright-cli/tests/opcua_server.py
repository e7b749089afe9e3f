"""An OPC UA server for the tests: takes rows on standard input and sets its variables, with the times of the rows.

A line is `TIME,NAME=VALUE,…`, `cut` (drops all connections) or `end`; each is answered with `done`. What a client writes or calls is
reported as `written` or `called`.
"""

import asyncio
import sys
from datetime import datetime, timezone

from asyncua import Server, ua
from asyncua.server.internal_session import InternalSession


def watched(name, what):
    """Reports when a client uses a service that changes something."""
    own = getattr(InternalSession, name)

    async def service(self, *arguments, **named):
        if self.external:
            print(what, flush=True)
        return await own(self, *arguments, **named)

    setattr(InternalSession, name, service)


async def main(port):
    watched("write", "written")
    watched("call", "called")
    server = Server()
    await server.init()
    server.set_endpoint(f"opc.tcp://127.0.0.1:{port}/")
    server.set_security_policy([ua.SecurityPolicyType.NoSecurity])
    space = await server.register_namespace("urn:cell")
    nodes = {}
    for name, value in [("n", 0.0), ("current", 0.0), ("event", "")]:
        node = ua.NodeId(f"Power.{name}", space)
        nodes[name] = await server.nodes.objects.add_variable(node, name, value)
    async with server:
        print("ready", flush=True)
        reader = asyncio.StreamReader(limit=1 << 24)
        loop = asyncio.get_running_loop()
        await loop.connect_read_pipe(lambda: asyncio.StreamReaderProtocol(reader), sys.stdin)
        while line := (await reader.readline()).decode().strip():
            if line == "end":
                break
            if line == "cut":
                for transport in list(server.iserver.asyncio_transports):
                    transport.abort()
            else:
                time, *cells = line.split(",")
                at = datetime.fromtimestamp(float(time), timezone.utc)
                for name, value in (cell.split("=") for cell in cells):
                    value = value if name == "event" else float(value)
                    value = ua.DataValue(ua.Variant(value), SourceTimestamp=at)
                    await nodes[name].write_value(value)
            print("done", flush=True)


asyncio.run(main(int(sys.argv[1])))
