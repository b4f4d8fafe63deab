"""What Linux's drivers of character devices do with a program's calls, over simulated buses.

Requests, limits and errors are the kernel's; `i2c_dev`, `spidev` and `gpio` are named as its drivers are.
"""

from .gpio import GPIOChip, GPIOLines, SysfsLines
from .i2c_dev import I2CFile
from .spidev import SPIFile

__all__ = ["GPIOChip", "GPIOLines", "I2CFile", "SPIFile", "SysfsLines"]
