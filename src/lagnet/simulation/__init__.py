"""Arms moved in PyBullet under torque control, with effects of the catalogue injected and the truth kept apart."""
