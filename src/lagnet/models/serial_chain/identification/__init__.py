"""From torque to the constants of a serial arm: relaxation, search, least squares, and what the motion determines."""
