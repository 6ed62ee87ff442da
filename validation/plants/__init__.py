"""Concealed plants: arms with hidden physics, simulated apart from the formulas that the diagnosis fits."""
