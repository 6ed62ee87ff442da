"""Robots that log commands and no torque: what of their servos is followed, and how it is fitted."""
