"""The serial link between a host and the firmware that drives a panel."""
