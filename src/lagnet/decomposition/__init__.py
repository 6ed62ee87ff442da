"""Where the torque goes: any model's inertial, Coriolis, gravity and residual torque along recordings; its energies."""
