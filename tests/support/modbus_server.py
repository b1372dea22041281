#!/usr/bin/python3
"""A Modbus server that shares nothing with ours: pymodbus (Debian: python3-pymodbus).

modbus_server.py tcp        prints the port it listens on, on 127.0.0.1
modbus_server.py rtu        prints the pseudo-terminal to open

Units 3 and 7 hold 200 registers, holding and input alike: register a of unit u is 1000 u + a.
Runs until it is killed.
"""
import asyncio
import os
import sys
import tty

from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus.framer.rtu_framer import ModbusRtuFramer
from pymodbus.framer.socket_framer import ModbusSocketFramer
from pymodbus.server.async_io import ModbusSerialServer, ModbusTcpServer


def unit(number):
    block = ModbusSequentialDataBlock(0, [1000 * number + address for address in range(200)])
    return ModbusSlaveContext(hr=block, ir=block, zero_mode=True)


def join(one, other):
    """What comes out of one pseudo-terminal goes into the other: two programs on one line."""
    loop = asyncio.get_running_loop()
    for source, sink in ((one, other), (other, one)):
        loop.add_reader(source, lambda source=source, sink=sink: os.write(sink, os.read(source, 512)))


async def serve(transport):
    context = ModbusServerContext(slaves={3: unit(3), 7: unit(7)}, single=False)
    if transport == "tcp":
        server = ModbusTcpServer(context, ModbusSocketFramer, address=("127.0.0.1", 0))
        serving = asyncio.create_task(server.serve_forever())
        await server.serving
        print(server.server.sockets[0].getsockname()[1], flush=True)
        await serving
        return
    ends = [os.openpty() for _ in range(2)]
    for _, far in ends:
        tty.setraw(far)
    join(ends[0][0], ends[1][0])
    server = ModbusSerialServer(
        context, ModbusRtuFramer, port=os.ttyname(ends[0][1]), baudrate=115200, parity="N",
        ignore_missing_slaves=True)
    await server.start()
    print(os.ttyname(ends[1][1]), flush=True)
    await server.serve_forever()


if __name__ == "__main__":
    asyncio.run(serve(sys.argv[1]))
