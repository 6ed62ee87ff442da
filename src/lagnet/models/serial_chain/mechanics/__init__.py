"""Mechanics of a serial arm of given constants: frames, inertias, Newton–Euler, what joints add, energies."""
