"""Concealed plants whose torque is as noisy as that of motor currents and light arms."""
