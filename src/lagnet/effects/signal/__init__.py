"""Effects of the sensors and of the clock, which act on the recorded signals."""
