#!/usr/bin/python3
"""Tries to write with pymodbus (Debian: python3-pymodbus), in every way that it knows.

modbus_writes.py PORT

Prints function and exception code of each answer, "6 1", or what came instead.
"""
import sys

from pymodbus.client import ModbusTcpClient

client = ModbusTcpClient("127.0.0.1", port=int(sys.argv[1]))
if not client.connect():
    sys.exit("no connection")
for reply in (
    client.write_coil(0, True, slave=1),
    client.write_register(0, 7, slave=1),
    client.write_coils(0, [True] * 8, slave=1),
    client.write_registers(0, [7, 8], slave=1),
    client.mask_write_register(0, 0, 7, slave=1),
    client.readwrite_registers(read_address=0, read_count=1, write_address=0, write_registers=[7],
                               slave=1),
):
    print(reply.original_code, reply.exception_code) if reply.isError() else print(reply)
client.close()
