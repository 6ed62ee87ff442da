"""From a command to joint torque: delay, dead band, gains, saturation and transmission losses, one law a file."""
