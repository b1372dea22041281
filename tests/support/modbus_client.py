#!/usr/bin/python3
"""A Modbus client that shares nothing with ours: pymodbus (Debian: python3-pymodbus).

modbus_client.py tcp:PORT|DEVICE UNIT FUNCTION ADDRESS COUNT

Prints the registers, "0 0 1 57864", or what came instead.
"""
import sys

from pymodbus.client import ModbusSerialClient, ModbusTcpClient

where = sys.argv[1]
unit, function, address, count = map(int, sys.argv[2:])
if where.startswith("tcp:"):
    client = ModbusTcpClient("127.0.0.1", port=int(where[4:]))
else:
    client = ModbusSerialClient(where, baudrate=115200, parity="N", timeout=5)
if not client.connect():
    sys.exit("no connection")
read = {3: client.read_holding_registers, 4: client.read_input_registers}[function]
reply = read(address, count, slave=unit)
client.close()
print(reply if reply.isError() else " ".join(map(str, reply.registers)))
