"""What Linux's drivers of character devices do with a program's calls, over simulated buses.

Requests, limits and errors are the kernel's; `i2c_dev`, `spidev` and `gpio` are named as its drivers are, and `server`
is how a program's calls get here.
"""
