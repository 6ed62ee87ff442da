"""Servo-driven arms written for simulators: position commands in, motion out."""
