"""Faults of the data that only a torque model shows: another order of joints, clock, unit or robot. One a file."""
